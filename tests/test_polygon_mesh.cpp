// Polygon meshes: faces become triangles that cover them exactly, and keep their numbers.
#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <random>

#include "accel/face_triangulation.h"
#include "decide.h"
#include "gltf_builder.h"
#include "loaders/gltf_polygons.h"
#include "renderer/render.h"
#include "renderer/surface.h"

namespace alhazen {
namespace {

using Triangle3 = std::array<uint32_t, 3>;
using Triangles = std::vector<Triangle3>;

// ---- Outlines on the lattice of whole numbers, where doubles are exact ----

using Outline = std::vector<Vec2d>;

double twice_area(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
double twice_area(const Outline& outline) {
  double sum = 0;
  for (size_t i = 1; i + 1 < outline.size(); ++i) sum += twice_area(outline[0], outline[i], outline[i + 1]);
  return sum;
}

bool is_between(const Vec2d& a, const Vec2d& b, const Vec2d& p) {
  return twice_area(a, b, p) == 0 && (p.x - a.x) * (p.x - b.x) + (p.y - a.y) * (p.y - b.y) <= 0;
}
bool meet(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  const bool apart = twice_area(a, b, c) * twice_area(a, b, d) >= 0 || twice_area(c, d, a) * twice_area(c, d, b) >= 0;
  return !apart || is_between(a, b, c) || is_between(a, b, d) || is_between(c, d, a) || is_between(c, d, b);
}

/// A random tour of random points with its crossings undone; empty where it still touches itself.
Outline random_simple_outline(Rng& rng, int corners, int size) {
  Outline p;
  for (int i = 0; i < corners; ++i) {
    const Vec3f at = uniform_lattice(rng, size);
    p.push_back({double(at.x), double(at.y)});
  }
  const size_t n = p.size();
  for (int round = 0; round < 1000; ++round) {
    bool simple = true;
    for (size_t i = 0; i < n && simple; ++i)
      for (size_t k = i + 2; k < n && simple; ++k) {
        if (i == 0 && k + 1 == n) continue;
        if (!meet(p[i], p[i + 1], p[k], p[(k + 1) % n])) continue;
        std::reverse(p.begin() + long(i) + 1, p.begin() + long(k) + 1);  // shorter, so that this ends
        simple = false;
      }
    if (!simple) continue;
    // Neighbours that fold back onto each other.
    for (size_t i = 0; i < n; ++i) {
      const Vec2d &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
      if (is_between(a, b, c) || is_between(b, c, a)) return {};
    }
    return p;
  }
  return {};
}

/// The outline in the plane origin + x u + y v.
std::vector<Vec3f> placed(const Outline& outline, const Vec3d& u, const Vec3d& v, const Vec3d& origin) {
  std::vector<Vec3f> corners;
  for (const Vec2d& p : outline) corners.push_back(Vec3f(u * p.x + v * p.y + origin));
  return corners;
}
std::vector<Vec3f> flat(const Outline& outline) { return placed(outline, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}); }

/// Triangles of the outline's own turn and exactly its area, bordered by its edges alone: they cover it once.
void expect_triangulation(const Outline& outline, const Triangles& triangles) {
  ASSERT_EQ(triangles.size() + 2, outline.size());
  const double area = twice_area(outline);
  double sum = 0;
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& t : triangles) {
    const double part = twice_area(outline[t[0]], outline[t[1]], outline[t[2]]);
    EXPECT_GT(part * area, 0);
    sum += part;
    for (size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}], --edges[{t[(k + 1) % 3], t[k]}];
  }
  EXPECT_EQ(sum, area);
  for (uint32_t i = 0; i < outline.size(); ++i)
    --edges[{i, (i + 1) % outline.size()}], ++edges[{(i + 1) % outline.size(), i}];
  for (const auto& [edge, count] : edges) EXPECT_EQ(count, 0) << edge.first << " " << edge.second;
}

const Outline kLShape{{1, 1}, {0, 1}, {0, 2}, {-2, 2}, {-2, 0}, {1, 0}};  // (0, 1) lies in a reflex corner's shadow
const Outline kStar{{0, 9}, {-2, 3}, {-9, 3}, {-3, -1}, {-5, -8}, {0, -4}, {5, -8}, {3, -1}, {9, 3}, {2, 3}};

TEST(FaceTriangulation, CoversRandomSimpleOutlinesOnce) {
  Rng rng(1);
  int concave = 0;
  for (int i = 0; i < 4000; ++i) {
    const Outline outline = random_simple_outline(rng, uniform_int(rng, 3, 24), i % 2 ? 8 : 1000);
    if (outline.empty()) continue;
    expect_triangulation(outline, triangulate(flat(outline)));
    const bool proper = is_proper_fan(flat(outline));
    concave += !proper;
    if (proper) {
      Triangles fan;
      for (uint32_t k = 1; k + 1 < outline.size(); ++k) fan.push_back({0, k, k + 1});
      expect_triangulation(outline, fan);
    }
  }
  EXPECT_GT(concave, 2000);
}

TEST(FaceTriangulation, CoversFacesInAnyPlaneAndOfAnySize) {
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Outline outline = random_simple_outline(rng, uniform_int(rng, 4, 16), 500);
    const Vec3f u = uniform_lattice(rng, 9), v = uniform_lattice(rng, 9);
    if (outline.empty() || cross(Vec3d(u), Vec3d(v)) == Vec3d{}) continue;
    const double scale = std::exp2(uniform_int(rng, -120, 100));
    const auto corners = placed(outline, Vec3d(u) * scale, Vec3d(v) * scale, Vec3d(uniform_lattice(rng, 99)) * scale);
    expect_triangulation(outline, triangulate(corners));
  }
}

TEST(FaceTriangulation, UsesCornersOnStraightSides) {
  // Left out of a triangle, such a corner would leave a gap towards the neighbouring face.
  const Outline square{{0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 3}, {4, 4}, {1, 4}, {0, 4}, {0, 2}};
  for (size_t first = 0; first < square.size(); ++first) {
    Outline turned = square;
    std::rotate(turned.begin(), turned.begin() + long(first), turned.end());
    expect_triangulation(turned, triangulate(flat(turned)));
  }
}

TEST(FaceTriangulation, CoversAFaceWithABridgeToItsHole) {
  const Outline ring{{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}};
  const Triangles triangles = triangulate(flat(ring));
  ASSERT_EQ(triangles.size(), 8u);
  double sum = 0;
  for (const auto& t : triangles) {
    const double area = twice_area(ring[t[0]], ring[t[1]], ring[t[2]]);
    EXPECT_GE(area, 0);
    sum += area;
    const Vec2d middle{(ring[t[0]].x + ring[t[1]].x + ring[t[2]].x) / 3,
                       (ring[t[0]].y + ring[t[1]].y + ring[t[2]].y) / 3};
    EXPECT_FALSE(area > 0 && middle.x > 3 && middle.x < 6 && middle.y > 3 && middle.y < 6);
  }
  EXPECT_EQ(sum, 2 * (81 - 9));
}

TEST(FaceTriangulation, ManagesFacesOfManyCorners) {
  Outline comb;  // leaning teeth, each in the way of none
  for (int i = 0; i < 20000; ++i) comb.push_back({double(i), 0}), comb.push_back({double(i) + 5000, 9999});
  comb.push_back({30000, -1});
  EXPECT_EQ(triangulate(flat(comb)).size(), comb.size() - 2);
  Outline gear;
  Rng rng(3);
  for (int i = 0; i < 50000; ++i) {
    const double angle = i * 2 * std::numbers::pi / 50000, r = uniform(rng, 1e6, 2e6);
    gear.push_back({std::round(r * std::cos(angle)), std::round(r * std::sin(angle))});
  }
  EXPECT_EQ(triangulate(flat(gear)).size(), gear.size() - 2);
}

TEST(FaceTriangulation, ComesToAnEndForOutlinesThatAreNone) {
  Rng rng(4);
  for (int i = 0; i < 20000; ++i) {
    std::vector<Vec3f> corners;
    const int n = uniform_int(rng, 3, 14), size = uniform_int(rng, 0, 3);
    for (int k = 0; k < n; ++k) corners.push_back(uniform_lattice(rng, size) * (i % 3 == 0 ? 1e38f : 1.0f));
    const Triangles triangles = triangulate(corners);
    EXPECT_TRUE(triangles.empty() || triangles.size() + 2 == corners.size());
    for (const auto& t : triangles) EXPECT_TRUE(std::max({t[0], t[1], t[2]}) < corners.size());
    EXPECT_FALSE(newell_normal(corners) == Vec3d{} && is_proper_fan(corners));
  }
}

// ---- Meshes ----

/// One polygon as the extension writes it.
TriangleMesh fan_mesh(const std::vector<Vec3f>& corners) {
  TriangleMesh part;
  part.positions = corners;
  for (uint32_t i = 1; i + 1 < corners.size(); ++i) part.triangles.push_back({0, i, i + 1});
  join_polygons(part);
  return part;
}

HitWave closest_hits(const Geometry& geometry, const RayWave& rays) {
  const std::vector<Opacity> opaque(1, Opacity::opaque);
  HitWave hits;
  AcceleratedScene(geometry, {opaque}).intersect(rays, Coherence::incoherent, hits);
  return hits;
}

/// How far p is from the nearest edge, at least in one of the axes' directions.
double edge_distance(const Outline& outline, const Vec2d& p) {
  double nearest = HUGE_VAL;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double s = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    nearest = std::min(nearest, std::hypot(a.x + s * dx - p.x, a.y + s * dy - p.y));
  }
  return nearest;
}

/// Rays through random points of the outline's plane, clear of its edges by what float traversal may mistake.
void expect_hits_of_the_exact_polygon(Rng& rng, const Outline& outline, const Vec3d& u, const Vec3d& v) {
  const std::vector<Vec3f> corners = placed(outline, u, v, {0, 0, 0});
  std::vector<Vec3d> loop;
  for (const Vec3f& p : corners) loop.push_back(Vec3d(p));
  Geometry mesh, exactly;
  mesh.meshes.push_back({"", {fan_mesh(corners)}});
  mesh.mesh_instances.push_back({0, 0, {}});
  exactly.shapes.push_back(make_polygon({loop}));
  exactly.shape_instances.push_back({0, 0, 0, {}});
  const Vec3d n = normalize(cross(u, v));
  double size = 1;
  for (const Vec2d& p : outline) size = std::max({size, std::abs(p.x), std::abs(p.y)});
  RayWave rays;
  while (rays.size() < 64) {
    const Vec2d at{uniform(rng, -1.1, 1.1) * size, uniform(rng, -1.1, 1.1) * size};
    if (edge_distance(outline, at) < 1e-3 * size) continue;
    const Vec3d p = u * at.x + v * at.y, from = p + (n + uniform_vector(rng, -0.3, 0.3)) * (size * length(u));
    const size_t i = rays.size();
    rays.resize(i + 1);
    rays.set(i, {Vec3f(from), Vec3f(p - from), 0, 10});
  }
  const HitWave by_mesh = closest_hits(mesh, rays), by_polygon = closest_hits(exactly, rays);
  for (size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(by_mesh.object[i], by_polygon.object[i]);
    if (by_mesh.object[i] == kNone) continue;
    EXPECT_NEAR(by_mesh.t[i], by_polygon.t[i], 1e-5);
    EXPECT_EQ(polygon_of(mesh.meshes[0].parts[0], by_mesh.primitive[i]), 0u);
  }
}

TEST(PolygonMesh, IsHitWhereTheExactPolygonIs) {
  Rng rng(5);
  for (int i = 0; i < 300; ++i) {
    const Outline outline = random_simple_outline(rng, uniform_int(rng, 3, 16), 60);
    const Vec3d u(uniform_lattice(rng, 5)), v(uniform_lattice(rng, 5));
    const double area = length(cross(u, v));
    // Skewed planes would make the distances to edges mean little.
    if (outline.empty() || !(area > 0.3 * length(u) * length(v)) || !(length(u) < 3 * length(v)) ||
        !(length(v) < 3 * length(u)))
      continue;
    expect_hits_of_the_exact_polygon(rng, outline, u, v);
  }
}

TEST(PolygonMesh, LShapesAndStarsHaveTheirNotchesFromEveryFirstVertex) {
  Rng rng(6);
  for (const Outline& shape : {kLShape, kStar})
    for (size_t first = 0; first < shape.size(); ++first) {
      Outline outline = shape;
      std::rotate(outline.begin(), outline.begin() + long(first), outline.end());
      expect_hits_of_the_exact_polygon(rng, outline, {1, 0, 0}, {0, 1, 0});
      expect_hits_of_the_exact_polygon(rng, outline, {0, 2, 1}, {2, 0, 0});
    }
}

TEST(PolygonMesh, InterpolatesWhatIsLinearOverAConcaveFaceAsLinear) {
  Scene scene;
  scene.materials.resize(1);
  TriangleMesh part;
  part.positions = flat(kStar);
  part.uvs.resize(1);
  for (const Vec3f& p : part.positions) part.uvs[0].push_back({0.25f * p.x - p.y, 3 + p.x});
  for (uint32_t i = 1; i + 1 < kStar.size(); ++i) part.triangles.push_back({0, i, i + 1});
  join_polygons(part);
  scene.geometry.meshes.push_back({"", {part}});
  scene.geometry.mesh_instances.push_back({0, 0, {}});
  Rng rng(7);
  RayWave rays;
  rays.resize(500);
  for (size_t i = 0; i < rays.size(); ++i)
    rays.set(i, {{float(uniform(rng, -9, 9)), float(uniform(rng, -9, 9)), 1}, {0, 0, -1}, 0, 2});
  const HitWave hits = closest_hits(scene.geometry, rays);
  int count = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits.object[i] == kNone) continue;
    const SurfacePoint s =
        surface_point(scene, rays.get(i), {0, 0, hits.primitive[i]}, hits.t[i], hits.u[i], hits.v[i]);
    const Vec3f p = rays.get(i).origin;
    EXPECT_NEAR(s.uvs[0].x, 0.25f * p.x - p.y, 1e-4);
    EXPECT_NEAR(s.uvs[0].y, 3 + p.x, 1e-4);
    EXPECT_EQ(s.ns_world, (Vec3f{0, 0, 1}));
    ++count;
  }
  EXPECT_GT(count, 100);
}

TEST(PolygonMesh, KeepsFansThatArePolygonsAndTrianglesThatAreNoFan) {
  const TriangleMesh convex = fan_mesh(flat({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}}));
  EXPECT_EQ(convex.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  TriangleMesh apart;
  apart.positions = flat({{0, 0}, {1, 0}, {1, 1}, {-1, 1}, {-1, 0}});
  apart.triangles = {{0, 1, 2}, {0, 3, 4}};
  join_polygons(apart);
  EXPECT_EQ(apart.triangles, (Triangles{{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(apart.polygon_of_triangle, (std::vector<uint32_t>{0, 0}));
}

TEST(PolygonMesh, OfTrianglesAloneIsATriangleMesh) {
  TriangleMesh part;
  part.positions = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  part.triangles = {{0, 1, 2}, {2, 3, 0}};
  join_polygons(part);
  EXPECT_TRUE(part.polygon_of_triangle.empty());
  EXPECT_TRUE(part.polygon_normals.empty());
  EXPECT_EQ(polygon_count(part), 2u);
  EXPECT_EQ(polygon_of(part, 1), 1u);
}

TEST(PolygonMesh, WithoutNormalsAFaceHasOneEvenWhereItIsNotFlat) {
  TriangleMesh part = fan_mesh({{0, 0, 0}, {1, 0, 0.5f}, {1, 1, 0}, {0, 1, 0.5f}});
  ASSERT_EQ(part.polygon_normals.size(), 1u);
  EXPECT_EQ(part.polygon_normals[0], (Vec3f{0, 0, 1}));  // Newell's
  Geometry geometry;
  geometry.meshes.push_back({"", {part}});
  geometry.mesh_instances.push_back({0, 0, {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}}});  // swaps x and z: a mirror
  bake_single_instances(geometry);
  EXPECT_EQ(geometry.meshes[0].parts[0].polygon_normals[0], (Vec3f{1, 0, 0}));
}

// ---- Files ----

const json kPolygons = {{"FB_ngon_encoding", json::object()}};

json primitive(GltfBuilder& b, const std::vector<float>& positions, const std::vector<uint16_t>& index) {
  return {{"attributes", {{"POSITION", b.vec3(positions)}}}, {"indices", b.index(index)}, {"extensions", kPolygons}};
}

/// Unit squares side by side from x = first on: `count` of them, as quads.
json row_of_quads(GltfBuilder& b, int first, int count) {
  std::vector<float> positions;
  std::vector<uint16_t> index;
  for (int i = 0; i <= count; ++i)
    for (const float y : {0.0f, 1.0f}) positions.insert(positions.end(), {float(first + i), y, 0});
  for (int i = 0; i < count; ++i) {
    const auto at = [&](int k) { return uint16_t(2 * i + k); };
    index.insert(index.end(), {at(0), at(2), at(3), at(0), at(3), at(1)});
  }
  return primitive(b, positions, index);
}

TEST(PolygonMesh, SignatureCountsPolygonsOnThroughTheMesh) {
  GltfBuilder b;
  json triangles = row_of_quads(b, 2, 2);
  triangles.erase("extensions");
  b.add("meshes", {{"primitives", {row_of_quads(b, 0, 2), triangles, row_of_quads(b, 4, 3)}}});
  b.add("nodes", {{"mesh", 0}});
  b.root["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 0.5}, {"znear", 0}, {"zfar", 9}}}}};
  b.add("nodes", {{"camera", 0}, {"translation", {3.5, 0.5, 1}}});
  b.root["extensionsUsed"] = {"FB_ngon_encoding"};
  b.root["extensionsRequired"] = {"FB_ngon_encoding"};
  Loaded loaded = load(b);
  EXPECT_TRUE(loaded.warnings.empty());
  Scene& scene = loaded.loaded.scene;
  bake_single_instances(scene.geometry);
  std::vector<Opacity> opacities;
  const AcceleratedScene accelerated(scene.geometry, surface_filter(scene, opacities));
  RenderOptions options;
  options.width = 28, options.height = 4, options.integrator = Integrator::signature;
  RenderControl control;
  const RenderResult result = render(scene, accelerated, scene.cameras.at(0), options, control);
  for (int x = 0; x < 28; ++x)
    for (int y = 0; y < 4; ++y) {
      // Two squares are 0 and 1, two are split into 2 to 5 along the diagonal, three are 6 to 8.
      const int square = x / 4, above = (3 - y) >= x % 4;
      if (square / 2 == 1 && 3 - y == x % 4) continue;  // on the diagonal
      const uint32_t expected = uint32_t(square < 2 ? square : square < 4 ? 2 + 2 * (square - 2) + above : square + 2);
      EXPECT_EQ(result.ids.pixels[size_t(y * 28 + x) * 3 + 1], expected) << x << " " << y;
    }
}

TEST(PolygonMesh, FileOfTrianglesIsTheSameWithTheExtension) {
  GltfBuilder b;
  json with = primitive(b, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 1, 2, 2, 3, 0}), without = with;
  without.erase("extensions");
  b.mesh(with), b.mesh(without);
  const Loaded loaded = load(b);
  EXPECT_EQ(loaded.part(0).triangles, loaded.part(1).triangles);
  EXPECT_TRUE(loaded.part(0).polygon_of_triangle.empty());
}

TEST(PolygonMesh, WithoutIndicesIsOfTriangles) {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(std::vector<float>(18, 1.0f))}}}, {"extensions", kPolygons}});
  EXPECT_EQ(polygon_count(load(b).part()), 2u);
}

TEST(PolygonMesh, OfZeroAreaOrRepeatedVerticesLoadsAsItIs) {
  GltfBuilder b;
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1, 0};
  b.mesh(primitive(b, positions, {0, 1, 2, 0, 2, 1, 0, 1, 0, 3, 3, 3, 3, 3, 3, 0, 0, 0, 0, 0, 1}));
  const TriangleMesh part = load(b).part();
  EXPECT_EQ(part.triangles.size(), 7u);
  EXPECT_EQ(part.polygon_of_triangle, (std::vector<uint32_t>{0, 0, 0, 1, 1, 2, 2}));
  RayWave rays;
  rays.resize(1);
  rays.set(0, {{1, 0, 1}, {0, 0, -1}, 0, 2});
  Geometry geometry;
  geometry.meshes.push_back({"", {part}});
  geometry.mesh_instances.push_back({0, 0, {}});
  EXPECT_EQ(closest_hits(geometry, rays).object[0], kNone);
}

TEST(PolygonMesh, ErrorsAreThoseOfTriangles) {
  const auto file = [](const std::vector<uint16_t>& index, const char* key, const json& value) {
    GltfBuilder b;
    json p = primitive(b, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, index);
    if (key) p[key] = value;
    b.mesh(p);
    return b;
  };
  EXPECT_EQ(error_of(file({0, 1, 2, 0, 2, 4}, nullptr, {}).document()),
            "/meshes/0/primitives/0/indices: index 4 out of range, POSITION has 4 vertices");
  EXPECT_TRUE(error_of(file({0, 1, 2}, "extensions", {{"FB_ngon_encoding", 1}}).document())
                  .starts_with("/meshes/0/primitives/0/extensions/FB_ngon_encoding: expected an object"));
  const Loaded cut = load(file({0, 1, 2, 0, 2}, nullptr, {}));
  EXPECT_EQ(polygon_count(cut.part()), 1u);
  EXPECT_EQ(cut.warnings.size(), 1u);
  const Loaded strip = load(file({0, 1, 3, 2}, "mode", 5));
  EXPECT_EQ(polygon_count(strip.part()), 2u);
  ASSERT_EQ(strip.warnings.size(), 1u);
  EXPECT_TRUE(strip.warnings[0].ends_with(": FB_ngon_encoding is ignored, it needs mode 4 (triangles)"));
}

}  // namespace
}  // namespace alhazen
