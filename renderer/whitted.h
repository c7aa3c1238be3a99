// Whitted's ray tree as waves: what one wave adds to the samples, and the wave that it spawns.
#pragma once

#include <array>

#include "renderer/render.h"
#include "renderer/surface.h"

namespace alhazen {

/// What a ray is for. A `straight` ray continues the view of its camera ray through surfaces with alpha.
enum class RayKind : uint8_t { camera, mirror, refracted, straight };

/// A wave of rays on their way to pixels.
struct PathWave {
  RayWave rays;
  Lanes<uint32_t> pixel;  // index of the sample's pixel within the cell
  Lanes<Rgb> weight;
  Lanes<uint16_t> depth;
  Lanes<RayKind> kind;

  [[nodiscard]] size_t size() const { return rays.size(); }
  void resize(size_t n) { rays.resize(n), pixel.resize(n), weight.resize(n), depth.resize(n), kind.resize(n); }
  void push(const Rayf& ray, uint32_t pixel_index, const Rgb& w, uint16_t d, RayKind k) {
    const size_t i = size();
    resize(i + 1);
    rays.set(i, ray), pixel[i] = pixel_index, weight[i] = w, depth[i] = d, kind[i] = k;
  }
};

/// Memory of one thread, reused from cell to cell.
struct WaveArena {
  PathWave current, pending;
  HitWave hits;
  RayWave shadow;
  Lanes<uint32_t> shadow_pixel;
  Lanes<Rgb> shadow_light, visible;
  std::array<uint64_t, 4> rays_by_kind{};  // by RayKind
  uint64_t shadow_rays = 0;
};

/// Follows the rays in `arena.pending` to their ends and adds their light to `radiance`, one value for each pixel of
/// the cell. With `options.transparent`, the background's colour is left out where the view meets it, and its share of
/// the pixel is added to `background` instead.
void trace_whitted(const Scene& scene, const AcceleratedScene& accelerated, const RenderOptions& options,
                   WaveArena& arena, Rgb* radiance, float* background);

}  // namespace alhazen
