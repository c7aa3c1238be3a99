// Benchmark scenes: that they are what the literature knows, and survive their way into glTF.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "core/error.h"
#include "loaders/gltf.h"
#include "procedural/databases.h"
#include "procedural/nff_reader.h"
#include "procedural/nff_to_gltf.h"
#include "procedural/tessellation.h"

namespace alhazen {
namespace {

NffScene made(const std::string& name, int size = 0) {
  for (const Database& d : databases())
    if (d.name == name) return d.make(size > 0 ? size : d.default_size);
  throw std::runtime_error(name);
}

LoadedScene through_gltf(const NffScene& scene, bool tessellate) {
  const auto file = std::filesystem::path(testing::TempDir()) / "procedural.glb";
  const std::vector<uint8_t> glb = glb_of(scene, {.tessellate = tessellate});
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(glb.data()), std::streamsize(glb.size()));
  return load_gltf(file, [](const std::string& warning) { ADD_FAILURE() << warning; });
}

TEST(Databases, HaveAsManyObjectsAsTheLiteratureSays) {
  const auto objects = [](const NffScene& s) { return s.spheres.size() + s.cones.size() + s.polygons.size(); };
  for (const auto& [name, count, lights] : {std::tuple{"balls", 7382u, 3u},
                                            {"gears", 9345u, 5u},
                                            {"mountain", 8196u, 1u},
                                            {"rings", 8401u, 3u},
                                            {"tetra", 4096u, 1u},
                                            {"tree", 8191u, 7u}}) {
    EXPECT_EQ(objects(made(name)), count) << name;
    EXPECT_EQ(made(name).lights.size(), lights) << name;
  }
}

TEST(Databases, AreFiniteAndRoundAtEverySize) {
  for (const Database& d : databases())
    for (int size = 1; size <= 3; ++size) {
      const NffScene scene = d.make(size);
      for (const NffSphere& s : scene.spheres) EXPECT_TRUE(is_finite(s.center) && s.radius > 0) << d.name;
      for (const NffCone& c : scene.cones) EXPECT_TRUE(is_finite(c.base) && length(c.apex - c.base) > 0) << d.name;
      for (const NffPolygon& p : scene.polygons) {
        EXPECT_TRUE(std::ranges::all_of(p.vertices, [](const Vec3d& v) { return is_finite(v); })) << d.name;
        for (const Vec3d& n : p.normals) EXPECT_NEAR(length(n), 1, 1e-12) << d.name;
      }
    }
}

TEST(Balls, EachTouchesTheOneThatBearsIt) {
  const NffScene scene = made("balls", 3);
  for (size_t i = 1; i < scene.spheres.size(); ++i) {
    const NffSphere& child = scene.spheres[i];
    const auto touches = [&](const NffSphere& s) {
      return std::abs(s.radius - 3 * child.radius) < 1e-12 &&
             std::abs(length(s.center - child.center) - s.radius - child.radius) < 1e-12;
    };
    EXPECT_EQ(std::count_if(scene.spheres.begin(), scene.spheres.begin() + long(i), touches), 1) << i;
  }
}

TEST(Teapot, HasItsNormalsOnTheSideOfItsWinding) {
  for (const NffPolygon& p : made("teapot").polygons) {
    if (p.normals.empty()) continue;
    const Vec3d n = cross(p.vertices[1] - p.vertices[0], p.vertices[2] - p.vertices[0]);
    for (const Vec3d& normal : p.normals) EXPECT_GT(dot(n, normal), 0);
  }
}

TEST(Tessellation, OfASphereIsClosedAndOutside) {
  for (const int segments : {3, 8, 33}) {
    const TriangleSoup soup = tessellated_sphere(segments);
    double volume = 0;
    for (size_t i = 0; i < soup.positions.size(); ++i) {
      EXPECT_NEAR(length(soup.positions[i]), 1, 1e-6);
      EXPECT_NEAR(dot(soup.positions[i], soup.normals[i]), 1, 1e-6);
    }
    for (const auto& [a, b, c] : soup.triangles) {
      const Vec3d p(soup.positions[a]), q(soup.positions[b]), r(soup.positions[c]);
      EXPECT_GT(dot(cross(q - p, r - p), p), 0);
      volume += dot(p, cross(q, r)) / 6;
    }
    EXPECT_LT(volume, 4.18879);
    if (segments > 30) {
      EXPECT_NEAR(volume, 4.18879, 0.07);
    }
  }
}

TEST(Tessellation, OfAFrustumHasItsArea) {
  for (const auto& [height, bottom, top] :
       {std::array{2.0, 1.0, 1.0}, {1.0, 0.5, 0.0}, {3.0, 0.0, 2.0}, {0.5, 1.0, 0.2}}) {
    const TriangleSoup soup = tessellated_frustum(height, bottom, top, 512);
    double area = 0;
    for (const auto& [a, b, c] : soup.triangles) {
      const Vec3d p(soup.positions[a]), q(soup.positions[b]), r(soup.positions[c]);
      const Vec3d n = cross(q - p, r - p);
      area += length(n) / 2;
      for (const uint32_t k : {a, b, c}) EXPECT_GT(dot(n, Vec3d(soup.normals[k])), 0);
    }
    EXPECT_NEAR(area, 3.14159265 * (bottom + top) * std::hypot(height, bottom - top), 1e-3 * area);
  }
}

TEST(Glb, HoldsEveryObjectExactlyOrAsTriangles) {
  for (const Database& d : databases()) {
    const NffScene scene = d.make(2);
    const Geometry exact = through_gltf(scene, false).scene.geometry, mesh = through_gltf(scene, true).scene.geometry;
    EXPECT_EQ(exact.shape_instances.size(), scene.spheres.size() + scene.cones.size()) << d.name;
    EXPECT_TRUE(mesh.shape_instances.empty()) << d.name;
    EXPECT_EQ(mesh.mesh_instances.size(), scene.spheres.size() + scene.cones.size() + !scene.polygons.empty())
        << d.name;
    for (size_t i = 0; i < scene.spheres.size(); ++i) {
      const ShapeInstance& placed = exact.shape_instances[i];
      EXPECT_EQ(std::get<Sphere>(exact.shapes[placed.shape]).radius, scene.spheres[i].radius);
      EXPECT_EQ(placed.world_from_object.origin, scene.spheres[i].center);
    }
  }
}

NffScene read(const std::string& text) {
  std::istringstream in(text);
  return read_nff(in, "scene.nff");
}

TEST(Nff, ReadsEveryEntity) {
  const NffScene s = read(
      "# a comment\nb 0.1 0.2 0.3\nv\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 40\nhither 1\nresolution 64 32\n"
      "l 1 2 3\nl 4 5 6 0.5 0.6 0.7\nf 1 .5 0 0.8 0.2 30 0.1 1.5\ns 1 2 3 0.5\nf 0 0 1 1 0 0 0 1\n"
      "c\n0 0 0 1\n0 0 2 0\np 3\n0 0 0\n1 0 0\n0 1 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n+1e0 1 0 0 0 1\n");
  EXPECT_EQ(s.view.from, (Vec3d{1, 2, 3}));
  EXPECT_EQ(std::tuple(s.view.angle, s.view.width, s.view.height), std::tuple(40, 64, 32));
  EXPECT_EQ(s.background, (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_FALSE(s.lights[0].has_color);
  EXPECT_EQ(s.lights[1].color, (Rgb{0.5f, 0.6f, 0.7f}));
  EXPECT_EQ(s.materials[0], (NffMaterial{{1, 0.5f, 0}, 0.8f, 0.2f, 30, 0.1f, 1.5f}));
  EXPECT_EQ(std::tuple(s.spheres[0].radius, s.spheres[0].material), std::tuple(0.5, 0u));
  EXPECT_EQ(std::tuple(s.cones[0].apex.z, s.cones[0].base_radius, s.cones[0].material), std::tuple(2, 1, 1u));
  EXPECT_EQ(s.polygons[0].vertices.size(), 3u);
  EXPECT_EQ(s.polygons[1].normals.size(), 3u);
}

TEST(Nff, NamesTheLineOfAnError) {
  for (const auto& [text, expected] :
       {std::pair{"b 0 0 0\ns 1 2\n3\n-1\n", "line 4: a radius must be above 0"},
        {"q 1\n", "line 1: unknown entity 'q'"},
        {"s 1 2 x 1\n", "line 1: expected a finite number, found 'x'"},
        {"s 1 2 nan 1\n", "line 1: expected a finite number"},
        {"s 1 2", "line 1: expected a number before the end"},
        {"p 2\n", "line 1: expected a whole number from 3"},
        {"p 1e30\n", "line 1: expected a whole number from 3"},
        {"c 0 0 0 1 0 0 0 1\n", "line 1: a cone must have a height"},
        {"v\nfrom 0 0 0\nat 0 0 1\nup 0 0 1\nangle 45\nhither 1\nresolution 8 8\n", "up is along it"},
        {"v\nat 0 0 0\n", "line 2: expected 'from', found 'at'"}})
    try {
      (void)read(text);
      ADD_FAILURE() << text;
    } catch (const LoadError& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
}

TEST(Nff, IsText) {
  try {
    (void)read(std::string("glTF\x02\0\0\0s 1 2 3 4\n", 18));
    ADD_FAILURE() << "bytes of 0 were read";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("line 1: holds a byte of 0, expected the text"), std::string::npos);
  }
}

}  // namespace
}  // namespace alhazen
