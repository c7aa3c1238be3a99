// Claims about points on surfaces worked out side by side: every lane has the bits that it has alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "renderer/lane_surfaces.h"
#include "tests/uniform.h"

namespace alhazen {
namespace {

using F = ShadingLanes;
constexpr size_t kLanes = kWidthOf<F>;
constexpr uint32_t kTriangles = 40;  // of each mesh

Vec3d vector(Uniform& uniform, float size) {
  return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
}

/// Turned and stretched; about half of them mirror.
Affine3d random_map(Uniform& uniform) {
  return {vector(uniform, 2), vector(uniform, 2), vector(uniform, 2), vector(uniform, 9)};
}

template <class V>
struct Values;
template <>
struct Values<float> {
  LaneArray<F> lanes;
  explicit Values(const F& x) { lanes.store(x); }
  bool are(size_t k, float one) const { return std::memcmp(&lanes[k], &one, sizeof one) == 0; }
};
template <class T>
struct Values<Vec3<T>> {
  using N = std::conditional_t<std::is_same_v<T, double>, DoubleOf<F>, F>;
  Vec3Array<N> lanes;
  explicit Values(const Vec3<N>& x) { lanes.store(x); }
  bool are(size_t k, const Vec3<T>& one) const { return lanes.get(k) == one; }
};

/// One that the shape has.
uint32_t random_face(Uniform& uniform, const Shape& shape) {
  const auto one_of = [&](const std::vector<uint32_t>& faces) { return faces[uniform.bits() % faces.size()]; };
  if (std::holds_alternative<Box>(shape)) return one_of({0, 1, 2, 3, 4, 5});
  if (std::holds_alternative<Disk>(shape)) return 3;
  if (std::holds_alternative<Cylinder>(shape)) return one_of({2, 3, kWallFace});
  if (std::holds_alternative<Quadric>(shape)) return one_of({0, 1, 2, 3, 4, 5, kWallFace, kWallFace});
  return kWallFace;
}

/// Of `objects`, at points about them; `u` and `v` for triangles. On one face of each shape, or on any.
LaneHits random_hits(Uniform& uniform, const Scene& scene, const std::vector<uint32_t>& objects, bool any_face = true) {
  LaneHits hits;
  for (size_t k = 0; k < kLanes; ++k) {
    const uint32_t object = objects[uniform.bits() % objects.size()];
    uint32_t part = 0, primitive = 0;
    if (!is_shape(scene.geometry, object))
      primitive = uniform.bits() % kTriangles;
    else if (any_face || k == 0)
      part = random_face(uniform, scene.geometry.shapes[shape_instance(scene.geometry, object).shape]);
    else
      part = hits.part[0];
    hits.object[k] = object, hits.part[k] = part, hits.primitive[k] = primitive;
    hits.origin.set(k, Vec3f(vector(uniform, 20))), hits.direction.set(k, uniform.direction());
    hits.t[k] = uniform(0, 20);
    hits.u[k] = uniform(0, 0.5), hits.v[k] = uniform(0, 0.5);
  }
  return hits;
}

/// Whether every lane has the bits of the hit alone; else the first that has not.
testing::AssertionResult are_as_alone(const Scene& scene, const LaneHits& hits, const Attributes& has,
                                      bool has_textures) {
  std::optional<LaneTriangles> triangles;
  const BasicSurfacePoint<F> lanes = surface_points(scene, hits, has, has_textures, triangles);
  constexpr float kWidth = 0.01f;
  const Values<float> curvature(mean_curvature(scene, hits, has, lanes, triangles, F(kWidth)));
  const Values<Vec3d> p(lanes.p_world);
  const Values<float> offset(lanes.offset);
  const Values<Vec3f> ng(lanes.ng_world), ns(lanes.ns_world), tangent(lanes.tangent_world);
  const Values<float> sign(lanes.bitangent_sign), u(lanes.uvs[0].x), v(lanes.uvs[0].y), rate(lanes.uv_per_metre[0]);
  for (size_t k = 0; k < kLanes; ++k) {
    const Rayf ray{hits.origin.get(k), hits.direction.get(k)};
    const SurfacePoint one = surface_point(scene, ray, hits.ids(k), hits.t[k], hits.u[k], hits.v[k]);
    if (!(p.are(k, one.p_world) && offset.are(k, one.offset) && ng.are(k, one.ng_world) && ns.are(k, one.ns_world)))
      return testing::AssertionFailure() << "lane " << k << ": place or normals";
    if (!curvature.are(k, mean_curvature(scene, hits.ids(k), one, kWidth)))
      return testing::AssertionFailure() << "lane " << k << ": curvature";
    if (!has_textures) continue;
    if (!(tangent.are(k, one.tangent_world) && sign.are(k, one.bitangent_sign)))
      return testing::AssertionFailure() << "lane " << k << ": tangent";
    if (!(u.are(k, one.uvs[0].x) && v.are(k, one.uvs[0].y) && rate.are(k, one.uv_per_metre[0])))
      return testing::AssertionFailure() << "lane " << k << ": texture coordinates";
  }
  return testing::AssertionSuccess();
}

/// What has a gradient of 0 on all of it: a double plane; or might: a parabolic cylinder.
Quadric double_plane(const Vec3d& n, double bend) {
  Quadric quadric;
  quadric.coefficients = {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z, 0, bend, 0, 0};
  return quadric;
}

TEST(LaneSurfaces, PointsOnShapesHaveTheBitsTheyHaveAlone) {
  Uniform uniform(11);
  for (int i = 0; i < 200; ++i) {
    Scene scene;
    scene.materials.resize(1);
    Quadric quadric;
    for (double& c : quadric.coefficients) c = uniform(-2, 2);
    const Vec3d a = vector(uniform, 3), b = vector(uniform, 3), c = vector(uniform, 3);
    const Cylinder cone{.height = uniform(0.1, 3), .radius_bottom = uniform(0.1, 3), .radius_top = 0},
        frustum{.height = uniform(0.1, 3), .radius_bottom = uniform(0.1, 3), .radius_top = uniform(0.1, 3)};
    scene.geometry.shapes = {Sphere{uniform(0.1, 3)},
                             quadric,
                             make_polygon({{a, b, c}}),
                             Box{Vec3d(2, 3, 4)},
                             Disk{},
                             cone,
                             frustum,
                             double_plane({1, -2, 4}, 0),
                             double_plane({3, 0, 0}, uniform(0.1, 1))};
    const auto shapes = uint32_t(scene.geometry.shapes.size());
    for (uint32_t shape = 0; shape < shapes; ++shape)
      for (int k = 0; k < 2; ++k) scene.geometry.shape_instances.push_back({shape, 0, 0, random_map(uniform)});
    for (const bool has_textures : {false, true}) {
      for (uint32_t shape = 0; shape < shapes; ++shape) {
        for (const bool any_face : {false, true})
          EXPECT_TRUE(are_as_alone(scene, random_hits(uniform, scene, {2 * shape}, any_face), {}, has_textures));
        EXPECT_TRUE(are_as_alone(scene, random_hits(uniform, scene, {2 * shape, 2 * shape + 1}), {}, has_textures));
      }
      EXPECT_TRUE(are_as_alone(scene, random_hits(uniform, scene, {0, 3, 4, 7, 9, 11, 13, 14, 17}), {}, has_textures));
      EXPECT_TRUE(are_as_alone(scene, random_hits(uniform, scene, {0, 11, 12}), {}, has_textures));
    }
  }
}

/// Where a surface has no normal, it turns to whoever looks.
TEST(LaneSurfaces, SingularPointsTurnToTheRay) {
  Scene scene;
  scene.materials.resize(1);
  Quadric cone;
  cone.coefficients = {1, -1, 1, 0, 0, 0, 0, 0, 0, 0};
  scene.geometry.shapes = {cone};
  scene.geometry.shape_instances.push_back({0, 0, 0, Affine3d{}});
  LaneHits hits;
  for (size_t k = 0; k < kLanes; ++k) {
    hits.object[k] = 0, hits.part[k] = kWallFace, hits.primitive[k] = 0, hits.u[k] = hits.v[k] = 0;
    hits.origin.set(k, {0, k % 2 ? 0.0f : 3.0f, k % 2 ? 3.0f : 0.0f}), hits.t[k] = 3;
    hits.direction.set(k, {0, k % 2 ? 0.0f : -1.0f, k % 2 ? -1.0f : 0.0f});
  }
  EXPECT_TRUE(are_as_alone(scene, hits, {}, false));
}

TEST(LaneSurfaces, PointsOnTrianglesHaveTheBitsTheyHaveAlone) {
  Uniform uniform(12);
  for (int i = 0; i < 300; ++i) {
    Scene scene;
    scene.materials.resize(1);
    TriangleMesh part;
    for (uint32_t k = 0; k < kTriangles; ++k) {
      part.positions.push_back(Vec3f(vector(uniform, k % 3 ? 3 : 1e-3f)));
      part.normals.push_back(uniform.direction());
      const Vec3f t = uniform.direction();
      part.tangents.push_back({t.x, t.y, t.z, k % 2 ? 1.0f : -1.0f});
      part.triangles.push_back({k, (k + 1) % kTriangles, (k + 7) % kTriangles});
    }
    part.uvs.emplace_back();
    for (int k = 0; k < int(kTriangles); ++k) part.uvs[0].push_back({uniform(-2, 2), uniform(-2, 2)});
    TriangleMesh flat = part;
    flat.normals.clear(), flat.tangents.clear();
    scene.geometry.meshes = {{"smooth", {part}}, {"flat", {flat}}};
    for (uint32_t mesh = 0; mesh < 2; ++mesh) {
      scene.geometry.mesh_instances.push_back({mesh, 0, Affine3d{}});
      scene.geometry.mesh_instances.push_back({mesh, 0, random_map(uniform)});
      scene.geometry.mesh_instances.push_back({mesh, 0, random_map(uniform)});
    }
    for (uint32_t mesh = 0; mesh < 2; ++mesh) {
      const Attributes has = attributes(scene.geometry.meshes[mesh].parts[0]);
      for (const std::vector<uint32_t>& objects :
           {std::vector{3 * mesh}, std::vector{3 * mesh + 1}, std::vector{3 * mesh, 3 * mesh + 1, 3 * mesh + 2}})
        EXPECT_TRUE(are_as_alone(scene, random_hits(uniform, scene, objects), has, true));
    }
  }
}

/// What clears a position's error is above its rounding, and hides nothing beyond the triangle's own size.
TEST(LaneSurfaces, NeedlesAskForNoMoreThanTheirLength) {
  Uniform uniform(13);
  for (int i = 0; i < 2000; ++i) {
    Scene scene;
    scene.materials.resize(1);
    TriangleMesh part;
    const double length = std::exp2(uniform(-10, 10)), width = length * std::exp2(uniform(-40, 0));
    const Vec3d along = Vec3d(uniform.direction()), aside = Vec3d(uniform.direction());
    part.positions = {Vec3f{}, Vec3f(along * length), Vec3f(aside * width)};
    part.triangles = {{0, 1, 2}};
    scene.geometry.meshes = {{"needle", {part}}};
    scene.geometry.mesh_instances.push_back({0, 0, Affine3d{}});
    const SurfacePoint s = surface_point(scene, {}, {0, 0, 0}, 0, 0.25f, 0.25f);
    if (!(dot(s.ng_world, s.ng_world) > 0)) continue;
    EXPECT_GT(double(s.offset), length * 0x1p-24);
    EXPECT_LT(double(s.offset), length * 1.001);
  }
}

}  // namespace
}  // namespace alhazen
