#include "accel/shape_geometry.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/fork_join.h"

namespace alhazen {
namespace {

constexpr double kLargestCoordinate = 1.844e18;  // beyond it, Embree drops primitives without a word
// The functions on lanes are flattened: a call for each operation on vectors would cost more than the operation.
constexpr unsigned kLanes = unsigned(DoubleLanes::size());

/// The largest float not above, the smallest not below.
float round_down(double x) {
  const float f = float(x);
  return double(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float round_up(double x) { return -round_down(-x); }

/// A box around the placed shape, larger by a few roundings of double.
Bounds3d conservative_bounds(const PlacedShape& placed) {
  const Bounds3d object = std::visit([](const auto& shape) { return bounds(shape); }, *placed.shape);
  if (is_empty(object)) return object;
  const Affine3d& m = *placed.world_from_object;
  const Bounds3d world = transform_bounds(m, object);
  const Vec3d reach = max(abs(object.lower), abs(object.upper));
  const Vec3d size = abs(m.x) * reach.x + abs(m.y) * reach.y + abs(m.z) * reach.z + abs(m.origin);
  return {world.lower - size * 1e-14, world.upper + size * 1e-14};
}

void write_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& group = *static_cast<const ShapeGroup*>(args->geometryUserPtr);
  const Bounds3d b = conservative_bounds(group.members[args->primID].placed);
  args->bounds_o->lower_x = round_down(b.lower.x), args->bounds_o->upper_x = round_up(b.upper.x);
  args->bounds_o->lower_y = round_down(b.lower.y), args->bounds_o->upper_y = round_up(b.upper.y);
  args->bounds_o->lower_z = round_down(b.lower.z), args->bounds_o->upper_z = round_up(b.upper.z);
}

Rayf ray_of(RTCRayN* ray, unsigned n, unsigned i) {
  return {{RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i)},
          {RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i)},
          RTCRayN_tnear(ray, n, i),
          RTCRayN_tfar(ray, n, i)};
}

Crossing crossing_of(const ShapeGroup::Member& member, const Rayf& ray, const ShapeHit& hit) {
  const Vec3d p_world = Vec3d(ray.origin) + Vec3d(ray.direction) * double(hit.t);
  return {member.object, hit.face, 0, 0, 0, map_point(member.placed.object_from_world, p_world)};
}

std::vector<ShapeHit>& hits_of(const ShapeGroup::Member& member, const Rayf& ray) {
  thread_local std::vector<ShapeHit> hits;
  hits.clear();
  append_hits(member.placed, ray, hits);
  return hits;
}

/// Takes a hit into the ray, unless one at the same distance has the smaller (geometry, primitive): which one is met
/// first must not depend on the order of traversal.
void take(const RTCIntersectFunctionNArguments* args, unsigned i, const ShapeHit& found) {
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  const uint32_t other = RTCHitN_geomID(hit, args->N, i);
  if (found.t == RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, args->N), args->N, i) && other != RTC_INVALID_GEOMETRY_ID &&
      (other < args->geomID || (other == args->geomID && RTCHitN_primID(hit, args->N, i) <= args->primID)))
    return;
  embree::accept(args, i, found.t);
  RTCHitN_u(hit, args->N, i) = float(found.face);
}

/// One ray after the other: for single rays, surfaces with holes, and the doubtful lanes of packets.
void intersect_lane(const RTCIntersectFunctionNArguments* args, const ShapeGroup& group,
                    const ShapeGroup::Member& member, unsigned i) {
  const Rayf ray = ray_of(RTCRayHitN_RayN(args->rayhit, args->N), args->N, i);
  for (const ShapeHit& hit : hits_of(member, ray)) {
    if (member.opacity == Opacity::cutout && !group.filter.is_present(group.filter.data, crossing_of(member, ray, hit)))
      continue;
    return take(args, i, hit);
  }
}

void occlude_lane(const RTCOccludedFunctionNArguments* args, const ShapeGroup& group, const ShapeGroup::Member& member,
                  unsigned i) {
  const Rayf ray = ray_of(args->ray, args->N, i);
  Rgb& visible = embree::query_of<WaveQuery>(args).visible[RTCRayN_id(args->ray, args->N, i)];
  for (const ShapeHit& hit : hits_of(member, ray)) {
    visible *= member.opacity == Opacity::opaque
                   ? Rgb(0.0f)
                   : group.filter.transmittance(group.filter.data, crossing_of(member, ray, hit));
    if (max_component(visible) > 0) continue;
    return embree::accept(args, i);
  }
}

/// Lanes [first, first + kLanes) of a packet; those beyond its end repeat the last.
struct PacketLanes {
  Vec3<DoubleLanes> origin, direction;
  DoubleLanes t_min, t_max;
  LaneMask active;
};

PacketLanes load_lanes(RTCRayN* ray, const int* valid, unsigned n, unsigned first) {
  const auto load = [&](auto& row) {
    if (first + kLanes <= n) return DoubleLanes(&row, std::experimental::element_aligned);
    return DoubleLanes([&](auto i) { return double((&row)[std::min(unsigned(i), n - first - 1)]); });
  };
  PacketLanes lanes;
  lanes.origin = {load(RTCRayN_org_x(ray, n, first)), load(RTCRayN_org_y(ray, n, first)),
                  load(RTCRayN_org_z(ray, n, first))};
  lanes.direction = {load(RTCRayN_dir_x(ray, n, first)), load(RTCRayN_dir_y(ray, n, first)),
                     load(RTCRayN_dir_z(ray, n, first))};
  lanes.t_min = load(RTCRayN_tnear(ray, n, first)), lanes.t_max = load(RTCRayN_tfar(ray, n, first));
  const DoubleLanes index([](auto i) { return double(i); });
  lanes.active = load(valid[first]) != 0.0 && index < double(n - first);
  return lanes;
}

int active_lanes(const int* valid, unsigned n) {
  int count = 0;
  for (unsigned i = 0; i < n; ++i) count -= valid[i];
  return count;
}

using LaneFlags = std::array<bool, kLanes>;

LaneFlags flags_of(const LaneMask& mask) {
  LaneFlags flags;
  mask.copy_to(flags.data(), std::experimental::element_aligned);
  return flags;
}

using LaneFloats = std::array<float, kLanes>;

LaneFloats floats_of(const DoubleLanes& x) {
  LaneFloats floats;
  x.copy_to(floats.data(), std::experimental::element_aligned);
  return floats;
}

/// Takes the hits of lanes that held nothing as near. A plain loop over rows, which compilers turn into masked stores.
void take_lanes(const RTCIntersectFunctionNArguments* args, unsigned first, const Nearest<DoubleLanes>& found,
                const LaneFlags& hits) {
  const unsigned n = args->N, count = std::min(kLanes, n - first);
  const LaneFloats t = floats_of(found.t), face = floats_of(found.face);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, n);
  float* t_far = &RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, n), n, first);
  float *u = &RTCHitN_u(hit, n, first), *v = &RTCHitN_v(hit, n, first);
  unsigned *geometry = &RTCHitN_geomID(hit, n, first), *primitive = &RTCHitN_primID(hit, n, first),
           *instance = &RTCHitN_instID(hit, n, first, 0);
  const unsigned geometry_id = args->geomID, primitive_id = args->primID, instance_id = args->context->instID[0];
  for (unsigned i = 0; i < count; ++i) {
    t_far[i] = hits[i] ? t[i] : t_far[i];
    u[i] = hits[i] ? face[i] : u[i];
    v[i] = hits[i] ? 0 : v[i];
    geometry[i] = hits[i] ? geometry_id : geometry[i];
    primitive[i] = hits[i] ? primitive_id : primitive[i];
    instance[i] = hits[i] ? instance_id : instance[i];
  }
  for (unsigned i = 0; i < count; ++i)
    if (hits[i]) embree::confirm(args, first + i);
}

template <class S>
[[gnu::flatten]] void intersect_lanes(const RTCIntersectFunctionNArguments* args, const ShapeGroup& group,
                                      const ShapeGroup::Member& member, unsigned first) {
  const PacketLanes lanes = load_lanes(RTCRayHitN_RayN(args->rayhit, args->N), args->valid, args->N, first);
  if (!any_of(lanes.active)) return;
  const auto line = object_line(member.placed.object_from_world, lanes.origin, lanes.direction);
  Nearest<DoubleLanes> found = nearest(crossings(std::get<S>(*member.placed.shape), line), lanes.t_min, lanes.t_max);
  found.hit = found.hit && lanes.active && !found.doubtful;
  if (any_of(found.hit && found.t == lanes.t_max)) {  // perhaps a tie: one by one
    const LaneFlags hits = flags_of(found.hit);
    for (unsigned i = 0; i < kLanes; ++i)
      if (hits[i]) take(args, first + i, {float(found.t[i]), uint32_t(double(found.face[i]))});
  } else if (any_of(found.hit)) {
    take_lanes(args, first, found, flags_of(found.hit));
  }
  if (!any_of(found.doubtful && lanes.active)) return;
  const LaneFlags doubtful = flags_of(found.doubtful && lanes.active);
  for (unsigned i = 0; i < kLanes; ++i)
    if (doubtful[i]) intersect_lane(args, group, member, first + i);
}

/// One ray in double; the doubtful go the long way.
template <class S>
[[gnu::flatten]] void intersect_quickly(const RTCIntersectFunctionNArguments* args, const ShapeGroup& group,
                                        const ShapeGroup::Member& member, unsigned i) {
  const Rayf ray = ray_of(RTCRayHitN_RayN(args->rayhit, args->N), args->N, i);
  const auto line = object_line(member.placed.object_from_world, Vec3d(ray.origin), Vec3d(ray.direction));
  const auto found = nearest(crossings(std::get<S>(*member.placed.shape), line), double(ray.t_min), double(ray.t_max));
  if (found.doubtful) return intersect_lane(args, group, member, i);
  if (found.hit) take(args, i, {float(found.t), uint32_t(found.face)});
}

constexpr int kFewLanes = 2;  // no more than these go one by one

template <class S>
void intersect_group(const RTCIntersectFunctionNArguments* args) {
  const auto& group = *static_cast<const ShapeGroup*>(args->geometryUserPtr);
  const ShapeGroup::Member& member = group.members[args->primID];
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) embree::reject(args, i);  // until a crossing is found to count
  if constexpr (!std::is_same_v<S, Composite>) {
    if (member.opacity != Opacity::cutout) {
      if (active_lanes(args->valid, args->N) <= kFewLanes) {
        for (unsigned i = 0; i < args->N; ++i)
          if (args->valid[i]) intersect_quickly<S>(args, group, member, i);
      } else {
        for (unsigned first = 0; first < args->N; first += kLanes) intersect_lanes<S>(args, group, member, first);
      }
      return;
    }
  }
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) intersect_lane(args, group, member, i);
}

template <class S>
[[gnu::flatten]] void occlude_lanes(const RTCOccludedFunctionNArguments* args, const ShapeGroup& group,
                                    const ShapeGroup::Member& member, unsigned first) {
  const PacketLanes lanes = load_lanes(args->ray, args->valid, args->N, first);
  if (!any_of(lanes.active)) return;
  const auto line = object_line(member.placed.object_from_world, lanes.origin, lanes.direction);
  const Blocked<DoubleLanes> found =
      blocked(crossings(std::get<S>(*member.placed.shape), line), lanes.t_min, lanes.t_max);
  const LaneFlags blocks = flags_of(found.blocked && lanes.active);
  for (unsigned i = 0; i < kLanes; ++i)
    if (blocks[i]) embree::accept(args, first + i);
  if (!any_of(found.doubtful && lanes.active)) return;
  const LaneFlags doubtful = flags_of(found.doubtful && lanes.active);
  for (unsigned i = 0; i < kLanes; ++i)
    if (doubtful[i]) occlude_lane(args, group, member, first + i);
}

template <class S>
[[gnu::flatten]] void occlude_quickly(const RTCOccludedFunctionNArguments* args, const ShapeGroup& group,
                                      const ShapeGroup::Member& member, unsigned i) {
  const Rayf ray = ray_of(args->ray, args->N, i);
  const auto line = object_line(member.placed.object_from_world, Vec3d(ray.origin), Vec3d(ray.direction));
  const auto found = blocked(crossings(std::get<S>(*member.placed.shape), line), double(ray.t_min), double(ray.t_max));
  if (found.doubtful) return occlude_lane(args, group, member, i);
  if (found.blocked) embree::accept(args, i);
}

template <class S>
void occlude_group(const RTCOccludedFunctionNArguments* args) {
  const auto& group = *static_cast<const ShapeGroup*>(args->geometryUserPtr);
  const ShapeGroup::Member& member = group.members[args->primID];
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) embree::reject(args, i);
  if constexpr (!std::is_same_v<S, Composite>) {
    if (member.opacity == Opacity::opaque) {  // what blocks need not be counted
      if (active_lanes(args->valid, args->N) <= kFewLanes) {
        for (unsigned i = 0; i < args->N; ++i)
          if (args->valid[i]) occlude_quickly<S>(args, group, member, i);
      } else {
        for (unsigned first = 0; first < args->N; first += kLanes) occlude_lanes<S>(args, group, member, first);
      }
      return;
    }
  }
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) occlude_lane(args, group, member, i);
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

void check_reach(const Geometry& geometry, const ShapeGroup::Member& member, const Bounds3d& b) {
  const double reach = std::max(max_component(abs(b.lower)), max_component(abs(b.upper)));
  if (!(reach < kLargestCoordinate))
    throw Error("the shape of node " + std::to_string(node_of(geometry, member.object)) +
                    " reaches further than 1.8e18 from the origin, more than traversal can hold",
                ExitStatus::input);
}

/// Fills in how lines come to each member, in parallel; 1 for those that have no surface.
std::vector<uint8_t> place_members(const Geometry& geometry, ShapeGroup& group) {
  std::vector<uint8_t> empty(group.members.size());
  const ForkJoin order;
  tbb::parallel_for(size_t(0), group.members.size(), order.task([&](size_t k) {
    ShapeGroup::Member& member = group.members[k];
    member.placed.object_from_world = line_map(*member.placed.world_from_object);
    const Bounds3d b = conservative_bounds(member.placed);
    empty[k] = is_empty(b);
    if (!empty[k]) check_reach(geometry, member, b);
  }));
  return empty;
}

}  // namespace

std::vector<std::unique_ptr<ShapeGroup>> group_shapes(const Geometry& geometry, const SurfaceFilter& filter) {
  std::vector<std::unique_ptr<ShapeGroup>> groups(std::variant_size_v<Shape>);
  for (uint32_t i = 0; i < geometry.shape_instances.size(); ++i) {
    const ShapeInstance& instance = geometry.shape_instances[i];
    const Shape& shape = geometry.shapes[instance.shape];
    auto& group = groups[shape.index()];
    if (!group) group = std::make_unique<ShapeGroup>(ShapeGroup{filter, {}});
    group->members.push_back({{{}, &instance.world_from_object, &shape},
                              uint32_t(geometry.mesh_instances.size()) + i,
                              filter.opacity.empty() ? Opacity::opaque : filter.opacity[instance.material]});
  }
  std::erase(groups, nullptr);
  for (auto& group : groups) {
    const std::vector<uint8_t> empty = place_members(geometry, *group);
    size_t k = 0;  // what has no surface is never hit
    std::erase_if(group->members, [&](const auto&) { return empty[k++] != 0; });
  }
  std::erase_if(groups, [](const auto& group) { return group->members.empty(); });
  return groups;
}

RTCGeometry new_shape_geometry(RTCDevice device, const ShapeGroup& group) {
  const Callbacks callbacks = callbacks_for(group.members.front().placed.shape->index(),
                                            std::make_index_sequence<std::variant_size_v<Shape>>());
  RTCGeometry g = embree::new_geometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, unsigned(group.members.size()));
  rtcSetGeometryUserData(g, const_cast<ShapeGroup*>(&group));
  rtcSetGeometryBoundsFunction(g, write_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, callbacks.intersect);
  rtcSetGeometryOccludedFunction(g, callbacks.occlude);
  rtcCommitGeometry(g);
  return g;
}

}  // namespace alhazen
