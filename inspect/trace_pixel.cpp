#include "inspect/trace_pixel.h"

#include <cmath>
#include <limits>

#include "inspect/tree_recorder.h"
#include "renderer/camera_cell.h"

namespace alhazen {
namespace {

constexpr size_t kMostOccluders = 32;
constexpr float kSameCrossing = 1e-5f;  // relative: nearer together, an object is met once

Rgb transmittance(const Scene& scene, const Rayf& ray, const HitIds& ids, const HitWave& hits, float time) {
  const SurfacePoint s = surface_point(scene, ray, ids, hits.t[0], hits.u[0], hits.v[0], time);
  return straight_transmittance(scene.materials[s.material], texture_table(scene), s.inputs());
}

/// The surfaces that a shadow ray crosses, up to the first opaque one.
std::vector<Occluder> occluders(const Scene& scene, const AcceleratedScene& accelerated, const Rayf& shadow,
                                std::optional<float> time) {
  std::vector<Occluder> found;
  RayWave wave;
  HitWave hits;
  wave.resize(1);
  if (time) wave.time.resize(1), wave.time[0] = *time;
  Rayf rest = shadow;
  HitIds last{kNone, 0, 0};
  float last_t = 0;
  for (size_t step = 0; step < 2 * kMostOccluders && found.size() < kMostOccluders; ++step) {
    wave.set(0, rest);
    accelerated.intersect(wave, Coherence::incoherent, hits);
    const HitIds ids{hits.object[0], hits.part[0], hits.primitive[0]};
    const float t = hits.t[0];
    if (ids.object == kNone) break;
    rest.t_min = std::nextafter(t, std::numeric_limits<float>::infinity());
    if (ids.object == last.object && t - last_t <= kSameCrossing * t) continue;
    last = ids, last_t = t;
    const SurfaceIds surface = surface_ids(scene, ids);
    found.push_back({surface.node, surface.material, t * length(shadow.direction),
                     transmittance(scene, shadow, ids, hits, time.value_or(0))});
    if (!(max_component(found.back().transmittance) > 0)) break;
  }
  return found;
}

}  // namespace

RayTree trace_pixel(const Scene& scene, const AcceleratedScene& accelerated, const Camera& camera,
                    const RenderOptions& options, int x, int y, int sample) {
  RayTree tree{
      .x = x, .y = y, .width = options.width, .height = options.height, .sample = sample, .samples = options.samples};
  TreeRecorder recorder(scene, uint32_t(y % kCellSize * kCellSize + x % kCellSize), sample);
  RenderControl control;
  const CellPicture cell = render_cell(scene, accelerated, camera, options, control, x, y, recorder);
  tree.rays = recorder.take(), tree.time = recorder.time();
  for (TreeRay& ray : tree.rays)
    for (TreeLight& light : ray.lights)
      if (light.visible != Rgb(1.0f)) light.occluders = occluders(scene, accelerated, light.shadow, tree.time);
  tree.radiance = sum_in_order(tree);
  const float* pixel = cell.color.at(x - cell.x0, y - cell.y0);
  tree.pixel = {pixel[0], pixel[1], pixel[2]}, tree.alpha = pixel[3];
  return tree;
}

}  // namespace alhazen
