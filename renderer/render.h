// From a scene to pixels: cells of pixels in parallel, each a sequence of waves.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "accel/accelerated_scene.h"
#include "core/image.h"
#include "renderer/layer.h"
#include "renderer/phase_clock.h"
#include "renderer/scene.h"
#include "renderer/wave_log.h"

namespace alhazen {

enum class Integrator : uint8_t { whitted, signature };

struct RenderOptions {
  int width = 1280, height = 720;
  Integrator integrator = Integrator::whitted;
  int max_depth = 5;
  float min_weight = 0.001f;
  int samples = 1;              // for each pixel
  bool transparent = false;     // where the view meets the background, alpha says so and its colour is left out
  int threads = 0;              // 0: all
  int tile_size = 64;           // pixels; rounded up to whole cells; never changes the picture
  std::vector<Layer> layers{};  // of whitted, besides the picture; each once
};

/// How far a render is, and the request to stop it: written and read by different threads.
struct RenderControl {
  std::atomic<bool> stop{false};
  std::atomic<uint32_t> tiles_done{0}, tiles{0};
  std::atomic<uint64_t> pixels_done{0};
  std::atomic<uint64_t> camera_rays{0}, shadow_rays{0}, mirror_rays{0}, refracted_rays{0};
  std::atomic<uint64_t> dropped_samples{0};               // not finite
  std::atomic<uint64_t> doubts{0};                        // crossings that doubles alone did not settle
  std::array<std::atomic<uint64_t>, kPhases> phase_ns{};  // by Phase, of all threads
  bool splits_shading = false;                            // PhaseClock's
  std::atomic<int64_t> first_tile_ns{0};  // when the first tile was finished, by the steady clock; 0: none is yet
  WaveLog* log = nullptr;                 // gets the waves of every cell, if there is one; they take much memory
};

/// Stopped early, every pixel is what the complete picture has there, or empty: 0 with alpha 0, or no node.
struct RenderResult {
  ColorImage color;                // whitted: R, G, B, A
  IdImage ids;                     // signature: node, primitive, material
  std::vector<LayerImage> layers;  // of the options' layers, in their order
  bool complete = true;
};

/// The filter by which `AcceleratedScene` asks this scene's materials; `scene` must outlive it, `opacity` is filled.
[[nodiscard]] SurfaceFilter surface_filter(const Scene& scene, std::vector<Opacity>& opacity);

/// Traces the picture. The same arguments give the same bits, whatever `threads` and `tile_size` are. The memory of
/// `used`, an earlier result, becomes that of the new one's picture: where frame follows frame, none is asked for.
[[nodiscard]] RenderResult render(const Scene& scene, const AcceleratedScene& accelerated, const Camera& camera,
                                  const RenderOptions& options, RenderControl& control, RenderResult used = {});

class TraceObserver;

/// The cell of pixels that holds (x, y), and where it lies in the picture.
struct CellPicture {
  int x0 = 0, y0 = 0;
  ColorImage color;  // empty where it was stopped
};

/// Traces that cell alone, by Whitted's integrator, as `render` does: the same rays in the same packets, to the same
/// bits; and tells `observer` of all of them, sample by sample.
[[nodiscard]] CellPicture render_cell(const Scene& scene, const AcceleratedScene& accelerated, const Camera& camera,
                                      const RenderOptions& options, RenderControl& control, int x, int y,
                                      TraceObserver& observer);

/// A three-quarter view of everything placed, as large as fits, for the aspect ratio width / height.
[[nodiscard]] Camera framing_camera(const Geometry& geometry, double aspect);

/// Key, fill and rim light about the camera, neutral; where the scene has neither ambient light nor an environment also
/// `studio_environment`; where it names no background, a grey one.
void add_studio_lights(Scene& scene, const Camera& camera);

}  // namespace alhazen
