#include "accel/shape_geometry.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"

namespace alhazen {
namespace {

constexpr double kLargestCoordinate = 1.844e18;  // beyond it, Embree drops primitives without a word
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

/// Calls f(lane) for each lane of the packet in `mask`.
template <class F>
void for_each_lane(const LaneMask& mask, unsigned first, const F& f) {
  for (unsigned i = 0; i < kLanes; ++i)
    if (mask[i]) f(first + i, i);
}

template <class S>
void intersect_group(const RTCIntersectFunctionNArguments* args) {
  const auto& group = *static_cast<const ShapeGroup*>(args->geometryUserPtr);
  const ShapeGroup::Member& member = group.members[args->primID];
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) embree::reject(args, i);  // until a crossing is found to count
  const auto one_by_one = [&] {
    for (unsigned i = 0; i < args->N; ++i)
      if (args->valid[i]) intersect_lane(args, group, member, i);
  };
  if constexpr (std::is_same_v<S, Composite>) {
    one_by_one();
  } else {
    if (args->N == 1 || member.opacity == Opacity::cutout) return one_by_one();
    const S& shape = std::get<S>(*member.placed.shape);
    RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
    for (unsigned first = 0; first < args->N; first += kLanes) {
      const PacketLanes lanes = load_lanes(ray, args->valid, args->N, first);
      if (!any_of(lanes.active)) continue;
      const auto line = object_line(member.placed.object_from_world, lanes.origin, lanes.direction);
      const NearestLanes found = nearest(crossings(shape, line), lanes.t_min, lanes.t_max);
      for_each_lane(lanes.active && found.hit && !found.doubtful, first, [&](unsigned lane, unsigned i) {
        take(args, lane, {float(found.t[i]), uint32_t(double(found.face[i]))});
      });
      for_each_lane(lanes.active && found.doubtful, first,
                    [&](unsigned lane, unsigned) { intersect_lane(args, group, member, lane); });
    }
  }
}

template <class S>
void occlude_group(const RTCOccludedFunctionNArguments* args) {
  const auto& group = *static_cast<const ShapeGroup*>(args->geometryUserPtr);
  const ShapeGroup::Member& member = group.members[args->primID];
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) embree::reject(args, i);
  const auto one_by_one = [&] {
    for (unsigned i = 0; i < args->N; ++i)
      if (args->valid[i]) occlude_lane(args, group, member, i);
  };
  if constexpr (std::is_same_v<S, Composite>) {
    one_by_one();
  } else {
    if (args->N == 1 || member.opacity != Opacity::opaque) return one_by_one();
    const S& shape = std::get<S>(*member.placed.shape);
    Rgb* visible = embree::query_of<WaveQuery>(args).visible;
    for (unsigned first = 0; first < args->N; first += kLanes) {
      const PacketLanes lanes = load_lanes(args->ray, args->valid, args->N, first);
      if (!any_of(lanes.active)) continue;
      const auto line = object_line(member.placed.object_from_world, lanes.origin, lanes.direction);
      const BlockedLanes found = blocked(crossings(shape, line), lanes.t_min, lanes.t_max);
      for_each_lane(lanes.active && found.blocked, first, [&](unsigned lane, unsigned) {
        visible[RTCRayN_id(args->ray, args->N, lane)] = Rgb(0.0f);
        embree::accept(args, lane);
      });
      for_each_lane(lanes.active && found.doubtful, first,
                    [&](unsigned lane, unsigned) { occlude_lane(args, group, member, lane); });
    }
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

void check_reach(const Geometry& geometry, const ShapeGroup::Member& member, const Bounds3d& b) {
  const double reach = std::max(max_component(abs(b.lower)), max_component(abs(b.upper)));
  if (!(reach < kLargestCoordinate))
    throw Error("the shape of node " + std::to_string(node_of(geometry, member.object)) +
                    " reaches further than 1.8e18 from the origin, more than traversal can hold",
                ExitStatus::input);
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
    std::vector<uint8_t> empty(group->members.size());
    tbb::parallel_for(size_t(0), group->members.size(), [&](size_t k) {
      ShapeGroup::Member& member = group->members[k];
      member.placed.object_from_world = line_map(*member.placed.world_from_object);
      const Bounds3d b = conservative_bounds(member.placed);
      empty[k] = is_empty(b);
      if (!empty[k]) check_reach(geometry, member, b);
    });
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
