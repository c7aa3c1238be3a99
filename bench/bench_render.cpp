// A whole frame beside the time that bare Embree needs for its camera rays alone, on the same threads. `vs_embree` is
// therefore the share of the frame that is not overhead, shading or secondary rays, and below 1.
#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <memory>

#include "bench/baseline.h"
#include "bench/contest.h"
#include "bench/scenes.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

constexpr int kImageSize = 512;
constexpr int kRaysPerTask = 1024;  // one cell's

/// The scene in both forms.
struct Stage {
  Scene scene = spheres_over_hills();
  Camera camera = framing_camera(scene.geometry, 1);
  std::vector<Opacity> opacity;
  SurfaceFilter filter = surface_filter(scene, opacity);
  AcceleratedScene ours{scene.geometry, filter};
  EmbreeBaseline embree{scene.geometry};
  std::vector<RayWave> camera_waves;

  Stage() {
    const RayWave all = camera_wave(camera, kImageSize);
    for (size_t first = 0; first < all.size(); first += kRaysPerTask) {
      RayWave& part = camera_waves.emplace_back();
      part.resize(kRaysPerTask);
      for (size_t i = 0; i < kRaysPerTask; ++i) part.set(i, all.get(first + i));
    }
  }
};

const Stage& stage() {
  static const Stage stage;
  return stage;
}

void trace_camera_rays() {
  const Stage& s = stage();
  tbb::parallel_for(size_t(0), s.camera_waves.size(), [&](size_t i) {
    benchmark::DoNotOptimize(s.embree.intersect(s.camera_waves[i], Coherence::coherent));
  });
}

void render_frame(Integrator integrator) {
  const Stage& s = stage();
  RenderOptions options;
  options.width = options.height = kImageSize, options.integrator = integrator;
  RenderControl control;
  benchmark::DoNotOptimize(render(s.scene, s.ours, s.camera, options, control));
}

[[maybe_unused]] const bool registered = [] {
  const std::string scene = "render/spheres_over_hills/";
  const double pixels = double(kImageSize) * kImageSize;
  const auto baseline = [=] { return stage(), Work{trace_camera_rays, pixels}; };
  for (const auto& [name, integrator] :
       {std::pair{"signature", Integrator::signature}, {"whitted", Integrator::whitted}})
    register_contest({scene + name + "/1spp",
                      "Mpixel/s",
                      Clock::wall,
                      [=, integrator = integrator] {
                        return stage(), Work{[=] { render_frame(integrator); }, pixels};
                      },
                      {{"embree_camera_rays", baseline}}});
  return true;
}();

}  // namespace
}  // namespace alhazen
