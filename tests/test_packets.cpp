// Claims about waves: how their rays are put into packets does not show in the answers.
#include <gtest/gtest.h>

#include <cstring>

#include "accel/accelerated_scene.h"
#include "tests/uniform.h"

namespace alhazen {
namespace {

/// Spheres and quadrics, so many that most packets meet several with a lane or two each.
Geometry random_shapes(Uniform& uniform, int count) {
  Geometry geometry;
  geometry.shapes = {Sphere{1.0}, Quadric{}};
  for (int i = 0; i < count; ++i) {
    Affine3d m;
    const double size = uniform(0.02f, 0.2f);
    m.x.x = m.y.y = m.z.z = size, m.origin = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    geometry.shape_instances.push_back({uint32_t(i % 2), uint32_t(i), 0, m});
  }
  return geometry;
}

/// From one place, more and more in all directions.
RayWave random_rays(Uniform& uniform, size_t count, float spread) {
  RayWave rays;
  for (size_t i = 0; i < count; ++i) {
    const Vec3f direction = Vec3f{0, 0, 1} + uniform.direction() * spread;
    rays.push({{uniform(-1, 1) * spread, uniform(-1, 1) * spread, -1.5f}, direction, 0, 3});
  }
  return rays;
}

TEST(Packets, AnswerAsTheirRaysDoAlone) {
  Uniform uniform(41);
  for (const float spread : {0.01f, 0.3f, 1.5f}) {
    const Geometry geometry = random_shapes(uniform, 500);
    const AcceleratedScene scene(geometry, {});
    const RayWave rays = random_rays(uniform, 3000, spread);
    HitWave hits, hit;
    Lanes<Rgb> visible, seen;
    scene.intersect(rays, Coherence::incoherent, hits), scene.transmittance(rays, Coherence::incoherent, visible);
    size_t met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      RayWave one;
      one.push(rays.get(i));
      scene.intersect(one, Coherence::incoherent, hit), scene.transmittance(one, Coherence::incoherent, seen);
      ASSERT_EQ(hits.object[i], hit.object[0]);
      ASSERT_EQ(visible[i].r, seen[0].r);
      if (hit.object[0] == kNone) continue;
      ++met;
      ASSERT_EQ(0, std::memcmp(&hits.t[i], &hit.t[0], sizeof(float)));
      ASSERT_TRUE(hits.part[i] == hit.part[0] && hits.primitive[i] == hit.primitive[0]);
    }
    EXPECT_GT(met, rays.size() / 4);
  }
}

TEST(Packets, MeetNothingInAnEmptyScene) {
  const Geometry geometry;
  const AcceleratedScene scene(geometry, {});
  Uniform uniform(42);
  const RayWave rays = random_rays(uniform, 100, 1);
  HitWave hits;
  Lanes<Rgb> visible;
  scene.intersect(rays, Coherence::coherent, hits), scene.transmittance(rays, Coherence::coherent, visible);
  for (size_t i = 0; i < rays.size(); ++i) EXPECT_TRUE(hits.object[i] == kNone && visible[i].r == 1);
}

}  // namespace
}  // namespace alhazen
