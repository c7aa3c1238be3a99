// The view of scenes that bring no camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "decide.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

/// Where points are in the picture: -1 ... 1 from one side to the other; `behind` where one is not before the camera.
struct Extent {
  double x_min = 2, x_max = -2, y_min = 2, y_max = -2;
  bool behind = false;
};

Extent extent_in_picture(const Geometry& geometry, const Camera& camera, double aspect) {
  const Affine3d& m = camera.world_from_camera;
  const double tan_y = std::tan(camera.yfov / 2);
  Extent extent;
  for (const MeshInstance placed : geometry.mesh_instances)
    for (const TriangleMesh& part : geometry.meshes[placed.mesh].parts)
      for (const auto& triangle : part.triangles)
        for (const uint32_t i : triangle) {
          const Vec3d p = transform_point(placed.world_from_object, Vec3d(part.positions[i])) - m.origin;
          const double depth = -dot(p, m.z);
          extent.behind |= !(depth > 0);
          const double x = dot(p, m.x) / depth / (tan_y * aspect), y = dot(p, m.y) / depth / tan_y;
          extent.x_min = std::min(extent.x_min, x), extent.x_max = std::max(extent.x_max, x);
          extent.y_min = std::min(extent.y_min, y), extent.y_max = std::max(extent.y_max, y);
        }
  return extent;
}

/// Triangles within a box of random proportions and place, and a vertex far away that none of them uses.
Geometry random_mesh(Rng& rng) {
  const Vec3d size{std::exp2(uniform(rng, -4, 4)), std::exp2(uniform(rng, -4, 4)), std::exp2(uniform(rng, -4, 4))};
  const Vec3d center = uniform_vector(rng, -100, 100);
  TriangleMesh part;
  for (uint32_t i = 0; i < 20; ++i) {
    for (int k = 0; k < 3; ++k) part.positions.emplace_back(center + uniform_vector(rng, -1, 1) * size);
    part.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  part.positions.push_back({1e6f, 1e6f, 1e6f});
  Geometry geometry;
  geometry.meshes.push_back({"", {part}});
  geometry.mesh_instances.push_back({0, 0, {}});
  return geometry;
}

TEST(FramingCamera, ShowsEverythingAsLargeAsFits) {
  Rng rng(7);
  for (int k = 0; k < 200; ++k) {
    Geometry geometry = random_mesh(rng);
    if (k % 2) geometry.mesh_instances.push_back({0, 0, {{0, 2, 0}, {-1, 0, 0}, {0, 0, 0.5}, {30, 0, 5}}});
    const double aspect = std::exp2(uniform(rng, -2, 2));
    const Extent e = extent_in_picture(geometry, framing_camera(geometry, aspect), aspect);
    EXPECT_FALSE(e.behind);
    // 0.94 of the width or of the height is filled, about the middle, and no more of the other.
    const double filled = std::max(e.x_max - e.x_min, e.y_max - e.y_min) / 2;
    EXPECT_NEAR(filled, 0.94, 1e-3);
    EXPECT_LT(std::max({e.x_max, e.y_max, -e.x_min, -e.y_min}), 0.95);
  }
}

TEST(FramingCamera, StandsBackFromAPointAndFromNothing) {
  Geometry geometry;
  EXPECT_TRUE(is_finite(framing_camera(geometry, 1.5).world_from_camera.origin));
  TriangleMesh point;
  point.positions.assign(3, Vec3f{1, 2, 3});
  point.triangles.push_back({0, 1, 2});
  geometry.meshes.push_back({"", {point}});
  geometry.mesh_instances.push_back({0, 0, {}});
  const Extent e = extent_in_picture(geometry, framing_camera(geometry, 1.5), 1.5);
  EXPECT_FALSE(e.behind);
  EXPECT_NEAR(e.x_min, 0, 1e-9);
  EXPECT_NEAR(e.y_max, 0, 1e-9);
}

}  // namespace
}  // namespace alhazen
