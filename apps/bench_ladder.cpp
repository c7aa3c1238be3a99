#include "apps/bench_ladder.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accel/accelerated_scene.h"
#include "accel/reference/ladder.h"
#include "loaders/gltf.h"
#include "loaders/image_decode.h"
#include "renderer/camera_ray.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

constexpr double kSecondsForEach = 2;
constexpr size_t kShares = 64;  // of the picture's rays: the slow accelerators may see only some

using Clock = std::chrono::steady_clock;

void print_warning(const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); }

/// One in `kShares` blocks of 4 x 4 pixels, spread over the picture; neighbours side by side.
RayWave share_of_camera_rays(const Camera& camera, int width, int height, size_t share) {
  const int blocks_x = (width + 3) / 4, blocks_y = (height + 3) / 4;
  RayWave rays;
  for (auto block = int(share); block < blocks_x * blocks_y; block += int(kShares))
    for (int k = 0; k < 16; ++k) {
      const int x = block % blocks_x * 4 + k % 4, y = block / blocks_x * 4 + k / 4;
      if (x >= width || y >= height) continue;
      rays.resize(rays.size() + 1);
      rays.set(rays.size() - 1, camera_ray(camera, width, height, x + 0.5, y + 0.5));
    }
  return rays;
}

struct Cost {
  double seconds = 0;
  uint64_t rays = 0;
  std::optional<TestCounts> tests;  // none where they cannot be counted

  [[nodiscard]] double seconds_per_ray() const { return seconds / double(rays); }
};

/// Traces share after share until all are traced or the time is up; always one.
template <class Trace>
Cost measure(const std::vector<RayWave>& shares, const Trace& trace) {
  Cost cost;
  HitWave hits;
  for (const RayWave& rays : shares) {
    const auto start = Clock::now();
    trace(rays, hits);
    cost.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    cost.rays += rays.size();
    if (cost.seconds > kSecondsForEach) break;
  }
  return cost;
}

Cost cost_of(const ReferenceAccelerator& accelerator, const std::vector<RayWave>& shares) {
  TestCounts tests;
  Cost cost = measure(shares, [&](const RayWave& rays, HitWave& hits) { accelerator.intersect(rays, hits, tests); });
  cost.tests = tests;
  return cost;
}

Cost cost_of(const AcceleratedScene& scene, const std::vector<RayWave>& shares) {
  return measure(shares, [&](const RayWave& rays, HitWave& hits) { scene.intersect(rays, Coherence::coherent, hits); });
}

void print_row(const std::string& name, const Cost& cost, const std::optional<Cost>& before) {
  char primitives[32] = "-", boxes[32] = "-", speed_up[32] = "-";
  if (cost.tests) {
    std::snprintf(primitives, sizeof primitives, "%.2f", double(cost.tests->primitives) / double(cost.rays));
    std::snprintf(boxes, sizeof boxes, "%.2f", double(cost.tests->boxes) / double(cost.rays));
  }
  if (before) std::snprintf(speed_up, sizeof speed_up, "%.2f x", before->seconds_per_ray() / cost.seconds_per_ray());
  std::printf("%-17s %12.3f %14s %10s %10s\n", name.c_str(), 1e6 * cost.seconds_per_ray(), primitives, boxes, speed_up);
  std::fflush(stdout);
}

}  // namespace

void print_ladder(const std::string& file, int width, int height) {
  LoadedScene loaded = load_gltf(file, print_warning);
  Scene& scene = loaded.scene;
  decode_textures(loaded, print_warning);
  bake_single_instances(scene.geometry);
  const Camera camera =
      scene.cameras.empty() ? framing_camera(scene.geometry, double(width) / height) : scene.cameras[0];
  std::vector<RayWave> shares;
  for (size_t share = 0; share < kShares; ++share) {
    RayWave rays = share_of_camera_rays(camera, width, height, share);
    if (rays.size() > 0) shares.push_back(std::move(rays));
  }

  std::vector<Opacity> opacities;
  const SurfaceFilter filter = surface_filter(scene, opacities);
  std::printf("%-17s %12s %14s %10s %10s\n", "accelerator", "us/ray", "primitives/ray", "boxes/ray", "speed-up");
  std::optional<Cost> before;
  for (const Rung& rung : reference_ladder(scene.geometry, filter, film_projection(camera))) {
    const Cost cost = cost_of(*rung.accelerator, shares);
    print_row(rung.name, cost, before);
    before = cost;
  }
  print_row("Embree", cost_of(AcceleratedScene(scene.geometry, filter), shares), before);
}

}  // namespace alhazen
