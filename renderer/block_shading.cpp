#include "renderer/block_shading.h"

#include <bit>

#include "core/lane_append.h"
#include "core/lane_memory.h"
#include "renderer/shading_terms.h"

namespace alhazen {
namespace {

using F = ShadingLanes;
using U = UintOf<F>;
constexpr size_t kLanes = kWidthOf<F>;

/// Lanes beyond the last hit are as the first.
void load_lanes(const Scene& scene, const WaveArena& arena, std::span<const uint32_t> hits, LaneWork& work) {
  const RayWave& rays = arena.current.rays;
  const PathRows& paths = arena.current.paths;
  const HitWave& found = arena.hits;
  LaneArray<IntOf<F>> numbers;
  for (size_t k = 0; k < kLanes; ++k) numbers[k] = int32_t(hits[k < hits.size() ? k : 0]);
  const LanePicker<F> picker(numbers.load(), hits.front(), hits.back());
  const auto load = [&](const Lanes<float>& row) { return picker.pick<F>(row); };
  const auto load_number = [&](const Lanes<uint32_t>& row) { return picker.pick<U>(row); };
  const F t = load(found.t);
  work.hits.object.store(load_number(found.object)), work.hits.part.store(load_number(found.part));
  work.hits.primitive.store(load_number(found.primitive));
  work.hits.origin.store({load(rays.origin.x), load(rays.origin.y), load(rays.origin.z)});
  work.hits.direction.store({load(rays.direction.x), load(rays.direction.y), load(rays.direction.z)});
  work.hits.t.store(t), work.hits.u.store(load(found.u)), work.hits.v.store(load(found.v));
  work.weight.store({load(paths.red), load(paths.green), load(paths.blue)});
  for (size_t k = 0; k < kLanes && paths.media.size() > 0; ++k) {
    const auto i = size_t(numbers[k]);
    work.weight.set(k, arriving_weight(paths[i], scene.materials, found.t[i]));
  }
  const BasicCone<F> cone = BasicCone<F>{load(paths.cone_width), load(paths.cone_spread)}.at(t);
  work.cone_width.store(cone.width), work.cone_spread.store(cone.spread);
  work.roughness.store(load(paths.roughness));
  work.pixel.store(load_number(paths.pixel)), work.depth.store(load_number(paths.depth));
}

/// Hit by hit: some may be of one pixel, whose sum depends on the order.
void add_to_pixels(const LaneLight& light, const LaneWork& work, size_t hits, Rgb* radiance) {
  for (size_t k = 0; k < hits; ++k) {
    Rgb& pixel = radiance[work.pixel[k]];
    if (light.emits) pixel += light.emission.get(k);
    if (light.reflects) pixel += light.ambient.get(k);
  }
}

void push_shadows(const LaneRays& rays, uint32_t lanes, const LaneWork& work, ShadowWave& wave) {
  const auto append = [&](Lanes<float>& row, const LaneArray<F>& values) { append_lanes(row, lanes, values.values); };
  append(wave.rays.origin.x, rays.origin.x), append(wave.rays.origin.y, rays.origin.y);
  append(wave.rays.origin.z, rays.origin.z), append(wave.rays.direction.x, rays.direction.x);
  append(wave.rays.direction.y, rays.direction.y), append(wave.rays.direction.z, rays.direction.z);
  append(wave.rays.t_min, LaneArray<F>{}), append(wave.rays.t_max, rays.t_max);
  append(wave.red, rays.weight.r), append(wave.green, rays.weight.g), append(wave.blue, rays.weight.b);
  append_lanes(wave.pixel, lanes, work.pixel.values);
}

/// Rays that leave a block in one way: those that are traced, and what is not the same for all ways.
struct Branch {
  const LaneRays& rays;
  uint32_t lanes;
  LaneArray<U> depth;
  std::array<RayKind, kLanes> kind;
  LaneArray<F> roughness;

  Branch(const LaneRays& leaving, uint32_t present, const U& depths, const RenderOptions& options)
      : rays(leaving), lanes(leaving.lanes & present) {
    if (lanes == 0) return;
    depth.store(depths);
    const F largest = max_component(rays.weight.load());
    const auto matters = largest >= F(options.min_weight) && largest > F(0);
    lanes &= lane_bits(matters && convert_mask<F>(depths <= U(uint32_t(options.max_depth))));
  }
};

/// What passes a texel that is not there at all gets no deeper.
Branch straight_branch(const LaneLight& light, const LaneWork& work, std::span<const uint32_t> hits,
                       const PathRows& paths, uint32_t present, const RenderOptions& options) {
  U depth = work.depth.load();
  if (light.straight.lanes != 0) depth = depth + select(convert_mask<U>(light.alpha.load() > F(0)), U(1), U(0));
  Branch branch(light.straight, present, depth, options);
  for (size_t k = 0; k < hits.size() && branch.lanes != 0; ++k)
    branch.kind[k] = kind_after(paths.kind[hits[k]], Bounce::straight);
  branch.roughness = work.roughness;
  return branch;
}

Branch bounced_branch(const LaneRays& rays, RayKind kind, const LaneLight& light, const LaneWork& work,
                      uint32_t present, const RenderOptions& options) {
  Branch branch(rays, present, work.depth.load() + U(1), options);
  branch.kind.fill(kind);
  if (branch.lanes != 0) branch.roughness.store(blurred_by(work.roughness.load(), light.roughness.load()));
  return branch;
}

void push_branch(const Branch& branch, std::span<const uint32_t> hits, const LaneWork& work, const PathRows& from,
                 PathWave& to) {
  if (branch.lanes == 0) return;
  size_t next = to.size();
  for (uint32_t lanes = from.media.size() > 0 ? branch.lanes : 0; lanes; lanes &= lanes - 1)
    to.paths.set_media(next++, from.media_of(hits[size_t(std::countr_zero(lanes))]));
  const LaneRays& rays = branch.rays;
  const auto count = size_t(std::popcount(branch.lanes));
  const auto append = [&](auto& row, const auto& values) { append_lanes(row, branch.lanes, values.values); };
  append(to.rays.origin.x, rays.origin.x), append(to.rays.origin.y, rays.origin.y);
  append(to.rays.origin.z, rays.origin.z), append(to.rays.direction.x, rays.direction.x);
  append(to.rays.direction.y, rays.direction.y), append(to.rays.direction.z, rays.direction.z);
  append_same<kLanes>(to.rays.t_min, count, Rayf{}.t_min), append_same<kLanes>(to.rays.t_max, count, Rayf{}.t_max);
  append(to.paths.red, rays.weight.r), append(to.paths.green, rays.weight.g), append(to.paths.blue, rays.weight.b);
  append_lanes(to.paths.kind, branch.lanes, branch.kind), append(to.paths.depth, branch.depth);
  append(to.paths.cone_spread, rays.cone_spread), append(to.paths.cone_width, work.cone_width);
  append(to.paths.pixel, work.pixel), append(to.paths.roughness, branch.roughness);
}

}  // namespace

void shade_block(const Scene& scene, const RenderOptions& options, const ShadingGroup& group,
                 std::span<const uint32_t> hits, WaveArena& arena, Rgb* radiance) {
  LaneWork& work = arena.lane_work;
  LaneLight& light = arena.lane_light;
  load_lanes(scene, arena, hits, work);
  shade_lanes(scene, group, work, arena.clock, light);
  add_to_pixels(light, work, hits.size(), radiance);
  const uint32_t present = (1u << hits.size()) - 1;
  for (size_t k = 0; k < light.shadow.size(); ++k) {
    const uint32_t lanes = light.shadow[k].lanes & present;
    if (lanes == 0) continue;
    push_shadows(light.shadow[k], lanes, work, arena.shadow_by_light[k]);
    arena.shadows_waiting += size_t(std::popcount(lanes));
  }
  if (((light.straight.lanes | light.mirror.lanes | light.refracted.lanes) & present) == 0) return;
  const PathRows& from = arena.current.paths;
  const auto push = [&](const Branch& branch, Bounce bounce) {
    push_branch(branch, hits, work, from, arena.spawned[bounce]);
  };
  push(straight_branch(light, work, hits, from, present, options), Bounce::straight);
  push(bounced_branch(light.mirror, RayKind::mirror, light, work, present, options), Bounce::mirror);
  push(bounced_branch(light.refracted, RayKind::refracted, light, work, present, options), Bounce::refracted);
}

}  // namespace alhazen
