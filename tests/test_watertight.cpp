#include <gtest/gtest.h>

#include <numbers>

#include "accel/accelerated_scene.h"
#include "decide.h"
#include "tests/trials.h"

namespace alhazen {
namespace {

/// A closed bumpy ball about 0, radii 1 to 6, its vertices multiples of 1/1024; no triangle without area.
TriangleMesh bumpy_ball(Rng& rng, uint32_t rows, uint32_t columns) {
  TriangleMesh mesh;
  const auto snap = [](double x) { return float(std::round(x * 1024) / 1024); };
  for (uint32_t i = 0; i <= rows; ++i)
    for (uint32_t j = 0; j < columns; ++j) {
      const double theta = std::numbers::pi * i / rows, phi = 2 * std::numbers::pi * j / columns;
      const double r = i == 0 || i == rows ? 4 : uniform(rng, 1, 6);
      mesh.positions.push_back({snap(r * std::sin(theta) * std::cos(phi)), snap(r * std::cos(theta)),
                                snap(r * std::sin(theta) * std::sin(phi))});
    }
  for (uint32_t i = 0; i < rows; ++i)
    for (uint32_t j = 0; j < columns; ++j) {
      const uint32_t k = (j + 1) % columns, a = i * columns + j, b = i * columns + k, c = a + columns, d = b + columns;
      if (i > 0) mesh.triangles.push_back({a, b, d});
      if (i + 1 < rows) mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// One mesh at each of the places.
Geometry placed(const TriangleMesh& mesh, const std::vector<Affine3d>& places) {
  Geometry geometry;
  geometry.meshes.push_back({"", {mesh}});
  for (const Affine3d& place : places) geometry.mesh_instances.push_back({0, 0, place});
  return geometry;
}

constexpr BuildOptions kWatertight{.robust = true, .threads = 1, .watertight = true};

HitWave hits_of(const AcceleratedScene& scene, const RayWave& rays, Coherence coherence) {
  HitWave hits;
  scene.intersect(rays, coherence, hits);
  return hits;
}

/// From about `center`, most of them exactly at vertices and middles of edges.
RayWave rays_from_within(Rng& rng, const TriangleMesh& mesh, const Affine3d& place, size_t count) {
  RayWave rays;
  rays.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const auto& corner = mesh.triangles[size_t(uniform_int(rng, 0, int(mesh.triangles.size()) - 1))];
    const Vec3f a = mesh.positions[corner[0]], b = mesh.positions[corner[1]];
    const int kind = uniform_int(rng, 0, 2);
    const Vec3f from = Vec3f(uniform_lattice(rng, 3)) * 0.0625f;
    const Vec3f at = kind == 0 ? a : kind == 1 ? (a + b) * 0.5f : Vec3f(uniform_vector(rng, -1, 1));
    rays.set(i, {Vec3f(transform_point(place, Vec3d(from))), Vec3f(transform_vector(place, Vec3d(at - from)))});
  }
  return rays;
}

TEST(Watertight, NoRayLeavesAClosedMeshHoweverItIsPlacedAndTraced) {
  Rng rng(91);
  const std::vector<std::vector<Affine3d>> placings{{Affine3d{}},
                                                    {Affine3d{}, {{0, 2, 0}, {-2, 0, 0}, {0, 0, 2}, {64, 0, 0}}},
                                                    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {512, -32, 8}}}};
  for (int i = 0; i < 6; ++i) {
    const TriangleMesh mesh = bumpy_ball(rng, 16, 16);
    for (const auto& places : placings) {
      const Geometry geometry = placed(mesh, places);
      const AcceleratedScene scene(geometry, {}, kWatertight);
      const RayWave rays = rays_from_within(rng, mesh, places.back(), size_t(trials(4000)));
      for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
        const HitWave hits = hits_of(scene, rays, coherence);
        Lanes<Rgb> visible;
        scene.transmittance(rays, coherence, visible);
        for (size_t k = 0; k < rays.size(); ++k) {
          ASSERT_NE(hits.object[k], kNone) << "mesh " << i << ", ray " << k;
          ASSERT_EQ(visible[k], Rgb(0.0f)) << "mesh " << i << ", ray " << k;
        }
      }
    }
  }
}

/// Rays from around a ball to anywhere near it.
RayWave rays_from_outside(Rng& rng, size_t count) {
  RayWave rays;
  rays.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const Vec3f from(normalize(uniform_vector(rng, -1, 1)) * 20.0);
    rays.set(i, {from, Vec3f(uniform_vector(rng, -4, 4)) - from});
  }
  return rays;
}

TEST(Watertight, HitsWhatEmbreesTrianglesHitAtTheSamePointOfTheTriangle) {
  Rng rng(92);
  const TriangleMesh mesh = bumpy_ball(rng, 24, 32);
  const Geometry geometry = placed(mesh, {Affine3d{}, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {3, 1, -2}}});
  const AcceleratedScene ours(geometry, {}, kWatertight), embrees(geometry, {});
  const RayWave rays = rays_from_outside(rng, 20000);
  const HitWave a = hits_of(ours, rays, Coherence::incoherent), b = hits_of(embrees, rays, Coherence::incoherent);
  int same = 0, hit = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    hit += b.object[i] != kNone;
    const bool same_triangle = a.object[i] == b.object[i] &&
                               (a.object[i] == kNone || (a.part[i] == b.part[i] && a.primitive[i] == b.primitive[i]));
    same += same_triangle;
    if (!same_triangle || a.object[i] == kNone) continue;
    EXPECT_NEAR(a.t[i], b.t[i], 1e-4f * b.t[i]);
    EXPECT_NEAR(a.u[i], b.u[i], 2e-3f);
    EXPECT_NEAR(a.v[i], b.v[i], 2e-3f);
  }
  EXPECT_GT(hit, 5000);
  EXPECT_GE(same, 19990);
}

/// Every other triangle is a hole; the others let half of the light pass.
bool is_present(const void*, const Crossing& crossing) noexcept { return crossing.primitive % 2 == 0; }
Rgb transmittance(const void*, const Crossing& crossing) noexcept {
  return is_present(nullptr, crossing) ? Rgb(0.5f, crossing.object == 0 ? 0.5f : 0.25f, 1.0f) : Rgb(1.0f);
}

void expect_the_same_holes_and_light(const Geometry& geometry, const RayWave& rays) {
  const std::vector<Opacity> cutout{Opacity::cutout};
  const SurfaceFilter filter{cutout, nullptr, is_present, transmittance};
  const AcceleratedScene ours(geometry, filter, kWatertight), embrees(geometry, filter);
  const HitWave a = hits_of(ours, rays, Coherence::coherent), b = hits_of(embrees, rays, Coherence::coherent);
  Lanes<Rgb> passes_a, passes_b;
  ours.transmittance(rays, Coherence::coherent, passes_a), embrees.transmittance(rays, Coherence::coherent, passes_b);
  int same_hit = 0, same_light = 0, tinted = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    same_hit += a.object[i] == b.object[i] && (a.object[i] == kNone || a.primitive[i] == b.primitive[i]);
    const Rgb off = passes_a[i] - passes_b[i];  // the order of the factors may differ
    same_light += std::abs(off.r) < 1e-6f && std::abs(off.g) < 1e-6f && std::abs(off.b) < 1e-6f;
    tinted += passes_b[i].r < 1;
  }
  EXPECT_GT(tinted, int(rays.size()) / 4);
  EXPECT_GE(same_hit, int(rays.size()) - 10);
  EXPECT_GE(same_light, int(rays.size()) - 10);
}

TEST(Watertight, AsksForHolesAndForTheLightThatPassesAsEmbreesTrianglesDo) {
  Rng rng(93);
  const TriangleMesh mesh = bumpy_ball(rng, 12, 16);
  std::vector<Affine3d> places{Affine3d{}, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {3, 1, -2}}};
  const RayWave rays = rays_from_outside(rng, 8000);
  expect_the_same_holes_and_light(placed(mesh, {Affine3d{}}), rays);
  expect_the_same_holes_and_light(placed(mesh, places), rays);
  while (places.size() < 1200) places.push_back({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, uniform_vector(rng, 100, 1000)});
  expect_the_same_holes_and_light(placed(mesh, places), rays);
}

TEST(Watertight, TrianglesWithoutAreaAreNeverHit) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {HUGE_VALF, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 1}, {3, 3, 3}, {0, 1, 4}};
  RayWave rays;
  rays.resize(16);
  for (size_t i = 0; i < 16; ++i) rays.set(i, {{float(i) / 8, 0, 1}, {0, 0, -1}});
  const Geometry geometry = placed(mesh, {Affine3d{}});
  const HitWave hits = hits_of(AcceleratedScene(geometry, {}, kWatertight), rays, Coherence::coherent);
  for (size_t i = 0; i < 16; ++i) EXPECT_EQ(hits.object[i], kNone);
}

}  // namespace
}  // namespace alhazen
