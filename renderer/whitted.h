// Whitted's ray tree as waves: what one wave adds to the samples, and the wave that it spawns.
#pragma once

#include <array>
#include <vector>

#include "renderer/camera_cell.h"
#include "renderer/hits_by_group.h"
#include "renderer/lane_shading.h"
#include "renderer/path_wave.h"
#include "renderer/phase_clock.h"
#include "renderer/render.h"
#include "renderer/surface.h"
#include "renderer/wave_log.h"

namespace alhazen {

class TraceObserver;

/// Memory of one thread, reused from cell to cell.
struct WaveArena {
  CellPixels pixels;
  PathWave current, pending;
  SpawnedWaves spawned;  // by the wave that is being shaded
  HitWave hits;
  std::vector<ShadowWave> shadow_by_light;
  Lanes<Rgb> visible;
  HitsByGroup hits_by_group;
  LaneWork lane_work;
  LaneLight lane_light;
  Lanes<float> time_of_pixel;              // of the shutter, of the samples at hand; of no elements where nothing moves
  std::array<uint64_t, 4> rays_by_kind{};  // by RayKind
  size_t shadows_waiting = 0;              // in `shadow_by_light`
  uint64_t shadow_rays = 0;                // traced
  PhaseClock clock;
  CellWaves* log = nullptr;           // where waves are copied to, if at all
  TraceObserver* observer = nullptr;  // who is told of every ray, if anybody

  /// Of the shutter, when all rays of the sample at hand are traced.
  [[nodiscard]] float time_of(uint32_t pixel_of_cell) const {
    return time_of_pixel.size() > 0 ? time_of_pixel[pixel_of_cell] : 0;
  }
};

/// Follows the rays in `arena.pending` to their ends and adds their light to `radiance`, one value for each pixel of
/// the cell. With `options.transparent`, the background's colour is left out where the view meets it, and its share of
/// the pixel is added to `background` instead.
void trace_whitted(const Scene& scene, const AcceleratedScene& accelerated, const ShadingGroups& groups,
                   const RenderOptions& options, WaveArena& arena, Rgb* radiance, float* background);

}  // namespace alhazen
