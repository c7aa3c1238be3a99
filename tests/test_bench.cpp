// What measurements are made of: statistics, and the record of a frame's rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "apps/sample_statistics.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

TEST(Median, IsTheMiddleOrTheMeanOfTheTwoThere) {
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({9, 1, 4}), 4);
  EXPECT_EQ(median({9, 1, 4, 6}), 5);
}

TEST(RelativeSpread, IsHalfTheQuartilesDistanceOverTheMedian) {
  EXPECT_EQ(relative_spread({2, 2, 2, 2}), 0);
  EXPECT_DOUBLE_EQ(relative_spread({1, 2, 3, 4, 5}), 1.0 / 3);
}

/// Every way to choose which ranks are a's.
double probability_by_counting(const std::vector<double>& a, const std::vector<double>& b) {
  const size_t n = a.size(), all = n + b.size();
  std::vector<double> ranked = a;
  ranked.insert(ranked.end(), b.begin(), b.end());
  std::ranges::sort(ranked);
  const auto u_of = [&](const auto& is_a) {
    double u = 0;
    for (size_t i = 0; i < all; ++i)
      for (size_t j = 0; j < i; ++j) u += is_a(i) && !is_a(j);
    return u;
  };
  const double middle = double(n * b.size()) / 2;
  const double found = std::abs(u_of([&](size_t i) { return std::ranges::find(a, ranked[i]) != a.end(); }) - middle);
  double as_extreme = 0, count = 0;
  for (uint32_t bits = 0; bits < 1u << all; ++bits) {
    if (size_t(std::popcount(bits)) != n) continue;
    ++count, as_extreme += std::abs(u_of([&](size_t i) { return (bits >> i & 1) != 0; }) - middle) >= found;
  }
  return as_extreme / count;
}

TEST(MannWhitney, CountsTheOrdersThatAreAsExtreme) {
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  EXPECT_DOUBLE_EQ(mann_whitney({1, 2, 3, 4, 5}, {6, 7, 8, 9, 10}), 2.0 / 252);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<double> a(2 + rng() % 5), b(2 + rng() % 5);
    for (double& x : a) x = normal(rng) + trial % 3;
    for (double& x : b) x = normal(rng);
    EXPECT_NEAR(mann_whitney(a, b), probability_by_counting(a, b), 1e-12);
    EXPECT_DOUBLE_EQ(mann_whitney(a, b), mann_whitney(b, a));
  }
}

TEST(MannWhitney, FindsADifferenceByChanceAsOftenAsItSays) {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> uniform;
  for (const size_t n : {9u, 40u}) {  // exact, and by the normal approximation
    int found = 0;
    for (int trial = 0; trial < 4000; ++trial) {
      std::vector<double> a(n), b(n);
      std::ranges::generate(a, [&] { return uniform(rng); });
      std::ranges::generate(b, [&] { return uniform(rng); });
      found += mann_whitney(a, b) < 0.05;
    }
    EXPECT_GT(found, 4000 * 0.03);
    EXPECT_LT(found, 4000 * 0.065);
  }
}

TEST(MannWhitney, OfEqualSamplesIsCertain) { EXPECT_EQ(mann_whitney({1, 1, 1}, {1, 1, 1, 1}), 1); }

/// Mirrors and lights, so that there are rays of every kind.
Scene spheres() {
  Scene scene;
  Material mirror;
  mirror.metallic = 1, mirror.roughness = 0;
  scene.materials = {mirror};
  scene.geometry.shapes = {Sphere{1}};
  for (int i = 0; i < 3; ++i)
    scene.geometry.shape_instances.push_back({0, 0, 0, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2.1 * (i - 1), 0, 0}}});
  return scene;
}

TEST(WaveLog, HoldsEveryRayOfTheFrame) {
  Scene scene = spheres();
  RenderOptions options;
  options.width = 100, options.height = 70, options.samples = 2;
  const Camera camera = framing_camera(scene.geometry, 100.0 / 70);
  add_studio_lights(scene, camera);
  std::vector<Opacity> opacity;
  const SurfaceFilter filter = surface_filter(scene, opacity);
  const AcceleratedScene accelerated(scene.geometry, filter);
  WaveLog log;
  RenderControl control;
  control.log = &log;
  (void)render(scene, accelerated, camera, options, control);
  uint64_t seen = 0, shadow = 0;
  for (const CellWaves& cell : log.cells())
    for (const LoggedWave& wave : cell) (is_shadow(wave.kind) ? shadow : seen) += wave.rays.size();
  EXPECT_EQ(seen, control.camera_rays + control.mirror_rays + control.refracted_rays);
  EXPECT_EQ(shadow, control.shadow_rays);
  EXPECT_GT(control.mirror_rays, 0u);
  EXPECT_GT(shadow, 0u);
  EXPECT_EQ(control.camera_rays, 2u * 100 * 70);
}

TEST(RenderControl, KnowsWhereTheTimeWent) {
  const Scene scene = spheres();
  RenderOptions options;
  options.width = options.height = 64, options.threads = 1;
  const AcceleratedScene accelerated(scene.geometry, {});
  RenderControl control;
  const auto start = std::chrono::steady_clock::now();
  (void)render(scene, accelerated, framing_camera(scene.geometry, 1), options, control);
  const auto wall = uint64_t(std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count());
  uint64_t spent = 0;
  for (size_t k = 0; k < kPhases; ++k) {
    const bool part_of_shading = Phase(k) == Phase::surface_points || Phase(k) == Phase::textures;
    EXPECT_EQ(control.phase_ns[k] == 0, part_of_shading);
    spent += control.phase_ns[k];
  }
  EXPECT_LE(spent, wall);
  EXPECT_GE(control.first_tile_ns, std::chrono::nanoseconds(start.time_since_epoch()).count());

  RenderControl split;
  split.splits_shading = true;
  (void)render(scene, accelerated, framing_camera(scene.geometry, 1), options, split);
  for (size_t k = 0; k < kPhases; ++k) EXPECT_EQ(split.phase_ns[k] == 0, Phase(k) == Phase::textures);  // it has none
}

}  // namespace
}  // namespace alhazen
