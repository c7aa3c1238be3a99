#include "accel/shape_geometry.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <string>

#include "accel/packet.h"
#include "accel/posed.h"
#include "accel/shape_bounds.h"
#include "accel/user_geometry.h"
#include "accel/wave_query.h"
#include "core/error.h"
#include "core/fork_join.h"

namespace alhazen {
namespace {

constexpr double kLargestCoordinate = 1.844e18;  // beyond it, Embree drops primitives without a word
// The functions on lanes are flattened: a call for each operation on vectors would cost more than the operation.

void bound(const RTCBoundsFunctionArguments* args) {
  const ShapeGroup& group = *static_cast<const ShapeGroup*>(args->geometryUserPtr);
  const PlacedShape& placed = group.members[args->primID].placed;
  write_bounds(args, conservative_bounds(*placed.world_from_object, object_bounds(*placed.shape)));
}

template <class Arguments>
const ShapeGroup& group_of(const Arguments* args) {
  return *static_cast<const ShapeGroup*>(args->geometryUserPtr);
}

Crossing crossing_of(const ShapeGroup& group, uint32_t k, const Rayf& ray, const ShapeHit& hit) {
  return {group.objects[k], hit.face, 0, 0, 0, object_point(group.members[k].placed.object_from_world, ray, hit.t)};
}

/// What a member lets pass wherever it is crossed.
std::optional<Rgb> transmittance_of(const ShapeGroup& group, uint32_t k) {
  const SurfaceFilter& filter = group.filter;
  return filter.shape_transmittance ? filter.shape_transmittance(filter.data, group.objects[k]) : std::nullopt;
}

std::vector<ShapeHit>& hits_of(const ShapeGroup::Member& member, const Rayf& ray) {
  thread_local std::vector<ShapeHit> hits;
  hits.clear();
  append_hits(member.placed, ray, hits);
  return hits;
}

/// One ray the long way: for surfaces with holes, composites, and what doubles leave in doubt.
void intersect_lane(const RTCIntersectFunctionNArguments* args, unsigned i) {
  const ShapeGroup& group = group_of(args);
  const uint32_t k = args->primID;
  const bool cutout = group.members[k].opacity == Opacity::cutout;
  const Rayf ray = rows_of(args).ray(i);
  for (const ShapeHit& hit : hits_of(group.members[k], ray)) {
    if (cutout && !group.filter.is_present(group.filter.data, crossing_of(group, k, ray, hit))) continue;
    return take(args, i, hit.t, float(hit.face), 0);
  }
}

void occlude_lane(const RTCOccludedFunctionNArguments* args, unsigned i) {
  const ShapeGroup& group = group_of(args);
  const uint32_t k = args->primID;
  const bool opaque = group.members[k].opacity == Opacity::opaque;
  const Rayf ray = rows_of(args).ray(i);
  Rgb& visible = embree::query_of<WaveQuery>(args).visible[RTCRayN_id(args->ray, args->N, i)];
  for (const ShapeHit& hit : hits_of(group.members[k], ray)) {
    visible *= opaque ? Rgb(0.0f) : group.filter.transmittance(group.filter.data, crossing_of(group, k, ray, hit));
    if (max_component(visible) > 0) continue;
    return embree::accept(args, i);
  }
}

/// The lanes of a packet whose rays may meet the member that is asked for. The query counts what it was asked with.
template <class Arguments>
uint32_t lanes_to_ask(const Arguments* args, const ShapeGroup& group, const RayRows& rays) {
  if (args->N > 1) {
    const WaveQuery& query = embree::query_of<WaveQuery>(args);
    const uint32_t active = with_width(args->N, [&](auto width) { return active_lanes<width>(args->valid); });
    ++query.shape_calls;
    query.shape_lanes += uint64_t(std::popcount(active));
  }
  return lanes_that_may_meet(group.balls[args->primID], rays, args->valid);
}

/// A member whose shape is of kind S, and the rays of a packet.
template <class S, class Arguments>
struct Meeting {
  const Arguments* args;
  const ShapeGroup& group;
  const ShapeGroup::Member& member;
  RayRows rays;

  explicit Meeting(const Arguments* arguments)
      : args(arguments), group(group_of(args)), member(group.members[args->primID]), rays(rows_of(args)) {}

  template <class T>
  [[nodiscard]] LineCrossings<T> crossings_of(const Vec3<T>& origin, const Vec3<T>& direction) const {
    return crossings(*std::get_if<S>(member.placed.shape),
                     object_line(member.placed.object_from_world, origin, direction));
  }
};

template <class S>
[[gnu::flatten]] void intersect_lanes(const Meeting<S, RTCIntersectFunctionNArguments>& m, unsigned first,
                                      uint32_t bits) {
  const PacketLanes lanes(m.rays, first);
  const Nearest<DoubleLanes> found = nearest(m.crossings_of(lanes.origin, lanes.direction), lanes.t_min, lanes.t_max);
  const uint32_t doubtful = lane_bits(found.doubtful) & bits, hit = lane_bits(found.hit) & bits & ~doubtful;
  if (hit) take_lanes(m.args, first, hit, floats_of(found.t), floats_of(found.face), {});
  for_each_bit(doubtful, [&](unsigned i) { intersect_lane(m.args, first + i); });
}

template <class S>
[[gnu::flatten]] void intersect_quickly(const Meeting<S, RTCIntersectFunctionNArguments>& m, unsigned i) {
  const Rayf ray = m.rays.ray(i);
  const Nearest<double> found =
      nearest(m.crossings_of(Vec3d(ray.origin), Vec3d(ray.direction)), double(ray.t_min), double(ray.t_max));
  if (found.doubtful) return intersect_lane(m.args, i);
  if (found.hit) take(m.args, i, float(found.t), float(found.face), 0);
}

template <class S>
void intersect_group(const RTCIntersectFunctionNArguments* args) {
  const Meeting<S, RTCIntersectFunctionNArguments> m(args);
  const uint32_t lanes = lanes_to_ask(args, m.group, m.rays);
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) embree::reject(args, i);  // until a crossing is found to count
  const auto one_by_one = [&](unsigned i) { intersect_lane(args, i); };
  if constexpr (std::is_same_v<S, Composite>) {
    for_each_bit(lanes, one_by_one);
  } else {
    if (m.member.opacity == Opacity::cutout) return for_each_bit(lanes, one_by_one);
    for_lanes(
        lanes, args->N, [&](unsigned i) { intersect_quickly(m, i); },
        [&](unsigned first, uint32_t bits) { intersect_lanes(m, first, bits); });
  }
}

template <class S>
[[gnu::flatten]] void occlude_lanes(const Meeting<S, RTCOccludedFunctionNArguments>& m, unsigned first, uint32_t bits) {
  const PacketLanes lanes(m.rays, first);
  const Blocked<DoubleLanes> found = blocked(m.crossings_of(lanes.origin, lanes.direction), lanes.t_min, lanes.t_max);
  for_each_bit(lane_bits(found.blocked) & bits, [&](unsigned i) { embree::accept(m.args, first + i); });
  for_each_bit(lane_bits(found.doubtful) & bits, [&](unsigned i) { occlude_lane(m.args, first + i); });
}

template <class S>
[[gnu::flatten]] void occlude_quickly(const Meeting<S, RTCOccludedFunctionNArguments>& m, unsigned i) {
  const Rayf ray = m.rays.ray(i);
  const Blocked<double> found =
      blocked(m.crossings_of(Vec3d(ray.origin), Vec3d(ray.direction)), double(ray.t_min), double(ray.t_max));
  if (found.doubtful) return occlude_lane(m.args, i);
  if (found.blocked) embree::accept(m.args, i);
}

/// Takes its share of a ray's light; none may be left.
void dim(const RTCOccludedFunctionNArguments* args, unsigned i, const Rgb& passing) {
  Rgb& visible = embree::query_of<WaveQuery>(args).visible[RTCRayN_id(args->ray, args->N, i)];
  visible *= passing;
  if (!(max_component(visible) > 0)) embree::accept(args, i);
}

/// Through a surface that lets the same light pass everywhere, crossing by crossing.
template <class S>
[[gnu::flatten]] void pass_lanes(const Meeting<S, RTCOccludedFunctionNArguments>& m, const Rgb& passing, unsigned first,
                                 uint32_t bits) {
  const PacketLanes lanes(m.rays, first);
  const Passed<DoubleLanes> found = passed(m.crossings_of(lanes.origin, lanes.direction), lanes.t_min, lanes.t_max);
  const uint32_t doubtful = lane_bits(found.doubtful) & bits;
  for (const auto& crossing : found.crossing)
    for_each_bit(lane_bits(crossing) & bits & ~doubtful, [&](unsigned i) { dim(m.args, first + i, passing); });
  for_each_bit(doubtful, [&](unsigned i) { occlude_lane(m.args, first + i); });
}

template <class S>
[[gnu::flatten]] void pass_quickly(const Meeting<S, RTCOccludedFunctionNArguments>& m, const Rgb& passing, unsigned i) {
  const Rayf ray = m.rays.ray(i);
  const Passed<double> found =
      passed(m.crossings_of(Vec3d(ray.origin), Vec3d(ray.direction)), double(ray.t_min), double(ray.t_max));
  if (found.doubtful) return occlude_lane(m.args, i);
  for (const bool crossing : found.crossing)
    if (crossing) dim(m.args, i, passing);
}

template <class S>
void occlude_group(const RTCOccludedFunctionNArguments* args) {
  const Meeting<S, RTCOccludedFunctionNArguments> m(args);
  const uint32_t lanes = lanes_to_ask(args, m.group, m.rays);
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) embree::reject(args, i);
  const auto one_by_one = [&](unsigned i) { occlude_lane(args, i); };
  if constexpr (std::is_same_v<S, Composite>) {
    for_each_bit(lanes, one_by_one);
  } else {
    if (m.member.opacity == Opacity::opaque)
      return for_lanes(
          lanes, args->N, [&](unsigned i) { occlude_quickly(m, i); },
          [&](unsigned first, uint32_t bits) { occlude_lanes(m, first, bits); });
    if (lanes == 0) return;
    const std::optional<Rgb> passing = transmittance_of(m.group, args->primID);
    if (!passing) return for_each_bit(lanes, one_by_one);
    for_lanes(
        lanes, args->N, [&](unsigned i) { pass_quickly(m, *passing, i); },
        [&](unsigned first, uint32_t bits) { pass_lanes(m, *passing, first, bits); });
  }
}

struct Callbacks {
  RTCIntersectFunctionN intersect;
  RTCOccludedFunctionN occlude;
};

/// By the alternative that a shape holds.
template <size_t... kKind>
Callbacks callbacks_for(size_t kind, std::index_sequence<kKind...>) {
  static constexpr Callbacks table[] = {{intersect_group<std::variant_alternative_t<kKind, Shape>>,
                                         occlude_group<std::variant_alternative_t<kKind, Shape>>}...};
  return table[kind];
}

/// Fills in how lines come to each member, in parallel; 1 for those that have no surface.
std::vector<uint8_t> place_members(const Geometry& geometry, ShapeGroup& group) {
  std::vector<uint8_t> empty(group.members.size());
  group.balls.resize(group.members.size());
  const ForkJoin order;
  tbb::parallel_for(size_t(0), group.members.size(), order.task([&](size_t k) {
    ShapeGroup::Member& member = group.members[k];
    member.placed.object_from_world = line_map(*member.placed.world_from_object);
    const Bounds3d object = object_bounds(*member.placed.shape);
    const Bounds3d world = conservative_bounds(*member.placed.world_from_object, object);
    empty[k] = is_empty(world);
    if (empty[k]) return;
    check_reach(geometry, group.objects[k], world);
    group.balls[k] = culling_ball(member.placed, object);
  }));
  return empty;
}

}  // namespace

void check_reach(const Geometry& geometry, uint32_t object, const Bounds3d& world) {
  const Bounds3f b = traversal_bounds(world);
  const auto reach = double(std::max(max_component(abs(b.lower)), max_component(abs(b.upper))));
  if (!(reach < kLargestCoordinate))
    throw Error("the shape of node " + std::to_string(node_of(geometry, object)) +
                    " reaches further than 1.8e18 from the origin, more than traversal can hold",
                ExitStatus::input);
}

std::vector<std::unique_ptr<ShapeGroup>> group_shapes(const Geometry& geometry, const SurfaceFilter& filter,
                                                      const std::function<bool(const ShapeInstance&)>& wanted) {
  std::vector<std::unique_ptr<ShapeGroup>> groups(std::variant_size_v<Shape>);
  for (uint32_t i = 0; i < geometry.shape_instances.size(); ++i) {
    const auto object = uint32_t(geometry.mesh_instances.size()) + i;
    const ShapeInstance& instance = geometry.shape_instances[i];
    if (track_of_object(geometry, object) || !wanted(instance)) continue;
    const Shape& shape = geometry.shapes[instance.shape];
    auto& group = groups[shape.index()];
    if (!group) group = std::make_unique<ShapeGroup>(ShapeGroup{filter, {}, {}, {}});
    group->members.push_back({{{}, &instance.world_from_object, &shape},
                              filter.opacity.empty() ? Opacity::opaque : filter.opacity[instance.material]});
    group->objects.push_back(object);
  }
  std::erase(groups, nullptr);
  for (auto& group : groups) {
    const std::vector<uint8_t> empty = place_members(geometry, *group);
    const auto erase = [&](auto& list) {  // what has no surface is never hit
      size_t k = 0;
      std::erase_if(list, [&](const auto&) { return empty[k++] != 0; });
    };
    erase(group->members), erase(group->balls), erase(group->objects);
  }
  std::erase_if(groups, [](const auto& group) { return group->members.empty(); });
  return groups;
}

void find_instances_again(const Geometry& geometry, ShapeGroup& group) {
  for (size_t k = 0; k < group.members.size(); ++k)
    group.members[k].placed.world_from_object = &shape_instance(geometry, group.objects[k]).world_from_object;
}

RTCGeometry new_shape_geometry(RTCDevice device, const ShapeGroup& group) {
  const Callbacks callbacks = callbacks_for(group.members.front().placed.shape->index(),
                                            std::make_index_sequence<std::variant_size_v<Shape>>());
  return new_user_geometry(device, {.primitives = group.members.size(),
                                    .data = &group,
                                    .bounds = bound,
                                    .intersect = callbacks.intersect,
                                    .occluded = callbacks.occlude});
}

}  // namespace alhazen
