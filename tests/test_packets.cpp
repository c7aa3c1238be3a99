// Claims about waves: how their rays are put into packets does not show in the answers.
#include <gtest/gtest.h>

#include <cmath>
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

Geometry placed(const TriangleMesh& part) {
  Geometry geometry;
  geometry.meshes.push_back({"", {part}});
  geometry.mesh_instances.push_back({0, 0, {}});
  return geometry;
}

/// Many triangles of all orientations.
Geometry random_triangles(Uniform& uniform, uint32_t count) {
  TriangleMesh part;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3f middle{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    for (int k = 0; k < 3; ++k) part.positions.push_back(middle + uniform.direction() * 0.15f);
    part.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return placed(part);
}

TEST(Packets, MeetTheTrianglesThatTheirRaysMeetAlone) {
  Uniform uniform(43);
  for (const float spread : {0.01f, 0.3f, 0.7f, 1.0f, 1.5f}) {  // of one octant, of four and of all
    const Geometry geometry = random_triangles(uniform, 2000);
    const AcceleratedScene scene(geometry, {});
    const RayWave rays = random_rays(uniform, 3000, spread);
    HitWave hits, hit;
    scene.intersect(rays, Coherence::incoherent, hits);
    size_t met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      RayWave one;
      one.push(rays.get(i));
      scene.intersect(one, Coherence::incoherent, hit);
      met += hit.object[0] != kNone;
      if (hits.object[i] == hit.object[0] && (hit.object[0] == kNone || hits.primitive[i] == hit.primitive[0]))
        continue;
      // On an edge, or where two triangles cross.
      ASSERT_TRUE(hits.object[i] != kNone && hit.object[0] != kNone) << spread << " " << i;
      ASSERT_NEAR(hits.t[i], hit.t[0], 1e-5f) << spread << " " << i;
    }
    EXPECT_GT(met, rays.size() / 8);
  }
}

TEST(Packets, APaneDimsEachOfTheirRaysOnce) {
  constexpr uint32_t kPanes = 5;
  TriangleMesh part;
  for (uint32_t i = 0; i < kPanes; ++i) {
    for (const Vec2f corner : {Vec2f{-90, -80}, {90, -80}, {0, 110}})
      part.positions.push_back({corner.x, corner.y, float(i)});
    part.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Geometry geometry = placed(part);
  const Opacity opacity[] = {Opacity::transparent};
  SurfaceFilter filter{opacity};
  filter.transmittance = [](const void*, const Crossing&) noexcept { return Rgb(0.5f, 0.75f, 1.0f); };
  const AcceleratedScene scene(geometry, filter);
  // Octants meet where a component is 0, of either sign, or next to it.
  constexpr float kComponents[] = {0.0f, -0.0f, 1e-20f, -1e-20f, 1e-30f, -1e-40f, 0.3f, -0.2f};
  Uniform uniform(44);
  RayWave rays;
  for (int i = 0; i < 4000; ++i) {
    const auto component = [&] { return kComponents[uniform.bits() % (i < 2000 ? 6 : 8)]; };
    const bool up = uniform.bits() % 2 == 0;
    rays.push({{uniform(-1, 1), uniform(-1, 1), up ? -1.0f : float(kPanes)},
               {component(), component(), up ? 1.0f : -1.0f},
               0,
               100});
  }
  Lanes<Rgb> visible;
  for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
    scene.transmittance(rays, coherence, visible);
    for (size_t i = 0; i < rays.size(); ++i) ASSERT_FLOAT_EQ(visible[i].r, std::pow(0.5f, float(kPanes))) << i;
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
