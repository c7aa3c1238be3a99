// Many instances of one mesh, traversed as a group, against the same ones placed one by one.
#include <gtest/gtest.h>

#include "accel/accelerated_scene.h"
#include "accel/instance_geometry.h"
#include "decide.h"

namespace alhazen {
namespace {

TriangleMesh tetrahedron() {
  TriangleMesh part;
  part.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  part.positions.reserve(part.positions.size() + 2);
  part.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  return part;
}

/// Instances at random; those with odd numbers are of mesh 0 and 1 in turn where they shall not form a group. The two
/// meshes are the same.
Geometry swarm(uint32_t count, bool grouped) {
  Geometry geometry;
  geometry.meshes = {{"a", {tetrahedron()}}, {"b", {tetrahedron()}}};
  Rng rng(1);
  for (uint32_t i = 0; i < count; ++i) {
    const Affine3d m{uniform_vector(rng, -1, 1), uniform_vector(rng, -1, 1), uniform_vector(rng, -1, 1),
                     uniform_vector(rng, -10, 10)};
    geometry.mesh_instances.push_back({grouped ? 0 : i % 2, i, m});
  }
  return geometry;
}

RayWave random_rays(size_t count) {
  Rng rng(2);
  RayWave rays;
  rays.resize(count);
  for (size_t i = 0; i < count; ++i)
    rays.set(i, {Vec3f(uniform_vector(rng, -15, 15)), Vec3f(uniform_vector(rng, -1, 1)), 0, 20});
  return rays;
}

Rgb half(const void*, const Crossing&) noexcept { return Rgb(0.5f); }
bool in_lower_half(const void*, const Crossing& crossing) noexcept { return crossing.u < 0.5f; }

constexpr uint32_t kCount = kLeastInstanceGroup + 500;

TEST(InstanceGroup, IsHitWhereItsInstancesAre) {
  const Geometry grouped = swarm(kCount, true), single = swarm(kCount, false);
  ASSERT_GE(group_size(grouped, 0), kLeastInstanceGroup);
  ASSERT_EQ(group_size(single, 0), 1u);
  const AcceleratedScene a(grouped, {}), b(single, {});
  const RayWave rays = random_rays(20000);
  for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
    HitWave hits_a, hits_b;
    a.intersect(rays, coherence, hits_a);
    b.intersect(rays, coherence, hits_b);
    Lanes<Rgb> visible_a, visible_b;
    a.transmittance(rays, coherence, visible_a);
    b.transmittance(rays, coherence, visible_b);
    size_t hit = 0, other = 0;  // the two round an instance's rays differently, which counts at edges
    for (size_t i = 0; i < rays.size(); ++i) {
      hit += hits_a.object[i] != kNone;
      const bool same = hits_a.object[i] == hits_b.object[i] &&
                        (hits_a.object[i] == kNone || hits_a.primitive[i] == hits_b.primitive[i]);
      other += !same || !(visible_a[i] == visible_b[i]);
      if (same && hits_a.object[i] != kNone) {
        EXPECT_NEAR(hits_a.t[i], hits_b.t[i], 1e-4f * hits_b.t[i] + 1e-4f);
      }
    }
    EXPECT_GT(hit, rays.size() / 4);
    EXPECT_LE(other, rays.size() / 1000);
  }
}

/// Two tetrahedra beside each other, everything larger by 2^exponent.
Geometry scaled_pair(int exponent) {
  const double s = std::ldexp(1.0, exponent);
  Geometry geometry;
  geometry.meshes = {{"a", {tetrahedron()}}};
  for (const double x : {-2.0, 2.0})
    geometry.mesh_instances.push_back({0, 0, {{s, 0, 0}, {0, s, 0}, {0, 0, s}, {x * s, 0, 0}}});
  return geometry;
}

HitWave hits_of_scaled_pair(int exponent) {
  Rng rng(3);
  RayWave rays;
  rays.resize(2000);
  for (size_t i = 0; i < rays.size(); ++i) {
    const Vec3f from(uniform_vector(rng, -5, 5)), to(uniform_vector(rng, -3, 3));
    rays.set(i, {from * std::ldexp(1.0f, exponent), to - from, 0, HUGE_VALF});
  }
  HitWave hits;
  AcceleratedScene(scaled_pair(exponent), {}).intersect(rays, Coherence::incoherent, hits);
  return hits;
}

TEST(Instances, AreHitAtScalesWhoseDeterminantNoFloatHolds) {
  const HitWave expected = hits_of_scaled_pair(0);
  for (const int exponent : {-56, -45, -30, -20, 20, 38, 45, 56}) {
    const HitWave hits = hits_of_scaled_pair(exponent);
    size_t other = 0;  // rounding counts at edges
    for (size_t i = 0; i < expected.object.size(); ++i) {
      other += hits.object[i] != expected.object[i];
      if (hits.object[i] != expected.object[i] || hits.object[i] == kNone) continue;
      EXPECT_NEAR(std::ldexp(double(hits.t[i]), -exponent), expected.t[i], 1e-4);
    }
    EXPECT_LE(other, 2u) << "2^" << exponent;
  }
}

TEST(Instances, AreMissedByRaysTooFarAwayForThem) {
  for (const int exponent : {-56, -20, 0}) {
    RayWave rays;
    rays.resize(1);
    rays.set(0, {{0, 1e18f, 0}, {0, -1, 0}, 0, HUGE_VALF});
    HitWave hits;
    AcceleratedScene(scaled_pair(exponent), {}).intersect(rays, Coherence::coherent, hits);
    EXPECT_EQ(hits.object[0], kNone) << "2^" << exponent;
  }
}

TEST(InstanceGroup, SurfacesWithHolesAndLightThroughThemAreSeenByTheirInstance) {
  const Geometry grouped = swarm(kCount, true), single = swarm(kCount, false);
  for (const Opacity kind : {Opacity::cutout, Opacity::transparent}) {
    const std::vector<Opacity> opacity{kind};
    SurfaceFilter filter;
    filter.opacity = opacity, filter.is_present = in_lower_half, filter.transmittance = half;
    const AcceleratedScene a(grouped, filter), b(single, filter);
    const RayWave rays = random_rays(5000);
    HitWave hits_a, hits_b;
    a.intersect(rays, Coherence::incoherent, hits_a);
    b.intersect(rays, Coherence::incoherent, hits_b);
    Lanes<Rgb> visible_a, visible_b;
    a.transmittance(rays, Coherence::incoherent, visible_a);
    b.transmittance(rays, Coherence::incoherent, visible_b);
    size_t other = 0, dimmed = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      other += hits_a.object[i] != hits_b.object[i] || !(visible_a[i] == visible_b[i]);
      dimmed += visible_a[i].r > 0 && visible_a[i].r < 1;
    }
    EXPECT_GT(dimmed, rays.size() / 10);
    EXPECT_LE(other, rays.size() / 500);
  }
}

}  // namespace
}  // namespace alhazen
