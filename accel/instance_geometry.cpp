#include "accel/instance_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "accel/packet.h"
#include "accel/posed.h"
#include "accel/user_geometry.h"

namespace alhazen {
namespace {

template <class Arguments>
const InstanceGroup& group_of(const Arguments* args) {
  return *static_cast<const InstanceGroup*>(args->geometryUserPtr);
}

Bounds3d mesh_box(RTCScene mesh) {
  RTCBounds box;
  rtcGetSceneBounds(mesh, &box);
  return {{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}};
}

/// A cluster's box; or that of the instance that moves, linear between two poses, for the mesh's own holds it always.
void bound(const RTCBoundsFunctionArguments* args) {
  const InstanceGroup& group = group_of(args);
  const Bounds3f box = group.places ? instance_box((*group.places)[args->timeStep], mesh_box(group.mesh))
                                    : group.clusters[args->primID].box;
  *args->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, 0};
}

/// Which rays of a packet meet a box.
template <int width>
class BoxTest {
  using F = FloatLanes<width>;

 public:
  explicit BoxTest(const RayRows& rays)
      : rays_(rays), origin_(load_origins<width>(rays)), inverse_(inverses(load_directions<width>(rays))) {}

  struct Entry {
    uint32_t lanes;  // of those that are asked for
    float t;         // where the first enters, if there are lanes
  };
  /// Up to what the segments are now. Leaves out no ray that meets the box: where it enters and leaves is compared with
  /// a margin of 16 roundings, of which 3 would do (Ize, "Robust BVH Ray Traversal", JCGT 2 (2), 2013).
  [[nodiscard]] Entry enter(const Bounds3f& box, uint32_t asked) const {
    F first(rays_.t_min(), std::experimental::element_aligned), last(rays_.t_max(), std::experimental::element_aligned);
    const auto clip = [&](const F& origin, const F& inverse, float lower, float upper) {
      const F a = (lower - origin) * inverse, b = (upper - origin) * inverse;
      first = larger(first, smaller(a, b)), last = smaller(last, larger(a, b));
    };
    clip(origin_.x, inverse_.x, box.lower.x, box.upper.x);
    clip(origin_.y, inverse_.y, box.lower.y, box.upper.y);
    clip(origin_.z, inverse_.z, box.lower.z, box.upper.z);
    const auto meets = first <= last * (1 + 0x1p-20f);
    const uint32_t lanes = lane_bits(meets) & asked;
    return {lanes, lanes ? std::experimental::hmin(select(meets, first, F(HUGE_VALF))) : 0};
  }

 private:
  static F inverse(const F& d) {
    constexpr float kLeast = 0x1p-100f;  // nothing is infinite times 0
    return 1.0f / select(absolute(d) < kLeast, select(d < 0.0f, F(-kLeast), F(kLeast)), d);
  }
  static Vec3<F> inverses(const Vec3<F>& d) { return {inverse(d.x), inverse(d.y), inverse(d.z)}; }

  RayRows rays_;
  Vec3<F> origin_, inverse_;
};

/// Calls visit(object, lanes) for the instances whose boxes rays meet, in the order in which the first ray enters them.
template <int width, class Visit>
void visit_nearest_first(const InstanceCluster& cluster, const RayRows& rays, uint32_t active, const Visit& visit) {
  struct Candidate {
    float t;
    uint32_t member;
  };
  const BoxTest<width> test(rays);
  std::array<Candidate, InstanceCluster::kMost> candidates;
  size_t count = 0;
  for (uint32_t k = 0; k < cluster.count; ++k) {
    const auto entry = test.enter(cluster.box_of(k), active);
    if (!entry.lanes) continue;
    size_t at = count++;
    for (; at > 0 && entry.t < candidates[at - 1].t; --at) candidates[at] = candidates[at - 1];
    candidates[at] = {entry.t, k};
  }
  for (size_t i = 0; i < count; ++i) {
    const uint32_t member = candidates[i].member;
    if (const uint32_t lanes = test.enter(cluster.box_of(member), active).lanes) visit(cluster.objects[member], lanes);
  }
}

template <class T>
bool within_reach(const Vec3<T>& v) {
  return max_component(abs(v)) < embree::kReach;
}
template <IsLanes F>
MaskOf<F> within_reach(const Vec3<F>& v) {
  return absolute(v.x) < embree::kReach && absolute(v.y) < embree::kReach && absolute(v.z) < embree::kReach;
}

/// The rays of a packet in the space of the mesh, all else as it was. Directions are not made unit length, so that t is
/// shared. Answers the lanes that go on: rays that are out of reach there miss.
template <int width, class Ray>
uint32_t enter(const Affine3d& world_from_object, const RayRows& from, uint32_t lanes, Ray& ray) {
  using F = FloatLanes<width>;
  constexpr auto anywhere = std::experimental::element_aligned;
  const Affine3f m(inverse(world_from_object));
  const auto all = [](const Vec3f& v) { return Vec3<F>(F(v.x), F(v.y), F(v.z)); };
  const Affine3<F> object_from_world(all(m.x), all(m.y), all(m.z), all(m.origin));
  const Vec3<F> o = transform_point(object_from_world, load_origins<width>(from)),
                d = transform_vector(object_from_world, load_directions<width>(from));
  std::memcpy(&ray, from.rows, sizeof ray);
  o.x.copy_to(ray.org_x, anywhere), o.y.copy_to(ray.org_y, anywhere), o.z.copy_to(ray.org_z, anywhere);
  d.x.copy_to(ray.dir_x, anywhere), d.y.copy_to(ray.dir_y, anywhere), d.z.copy_to(ray.dir_z, anywhere);
  return lane_bits(within_reach(o) && within_reach(d)) & lanes;
}

/// The same where the mesh is at each ray's time; rays miss it while it has no extent.
template <int width, class Ray>
uint32_t enter(const Track<Affine3d>& places, const RayRows& from, uint32_t lanes, Ray& ray) {
  std::memcpy(&ray, from.rows, sizeof ray);
  uint32_t within = 0;
  for_each_bit(lanes, [&](unsigned i) {
    const Affine3d then = at_time(places, from.time()[i]);
    if (!is_invertible(then)) return;
    const Affine3f object_from_world(inverse(then));
    const Rayf world = from.ray(i);
    const Vec3f o = transform_point(object_from_world, world.origin),
                d = transform_vector(object_from_world, world.direction);
    ray.org_x[i] = o.x, ray.org_y[i] = o.y, ray.org_z[i] = o.z;
    ray.dir_x[i] = d.x, ray.dir_y[i] = d.y, ray.dir_z[i] = d.z;
    if (within_reach(o) && within_reach(d)) within |= 1u << i;
  });
  return within;
}

/// Says in the context which instance is entered, until it is left.
class Entered {
 public:
  Entered(embree::CallbackContext& context, uint32_t object) : context_(context) {
    context_.instID[0] = kInGroup | object;
  }
  ~Entered() { context_.instID[0] = RTC_INVALID_GEOMETRY_ID; }
  Entered(const Entered&) = delete;
  Entered& operator=(const Entered&) = delete;

 private:
  embree::CallbackContext& context_;
};

template <class Arguments>
embree::Query& query_of(const Arguments* args) {
  return const_cast<embree::Query&>(embree::query_of<embree::Query>(args));
}

/// As Embree wants it: -1 for the lanes whose bit is set, else 0.
template <int width>
struct Valid {
  alignas(64) std::array<int, width> lanes;
  explicit Valid(uint32_t bits) {
    for (unsigned i = 0; i < unsigned(width); ++i) lanes[i] = -int(bits >> i & 1);
  }
};

/// A hit of a mesh becomes the packet's, unless that has one at the same distance of a smaller (instance, geometry,
/// primitive): which instance is entered first must not count.
template <int width>
void take_hit(const RTCIntersectFunctionNArguments* args, unsigned i,
              const typename embree::Packets<width>::RayHit& found) {
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, width);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, width);
  const std::array ids{found.hit.instID[0][i], found.hit.geomID[i], found.hit.primID[i]};
  if (found.ray.tfar[i] == RTCRayN_tfar(rays, width, i) && RTCHitN_geomID(hits, width, i) != RTC_INVALID_GEOMETRY_ID) {
    const std::array other{RTCHitN_instID(hits, width, i, 0), RTCHitN_geomID(hits, width, i),
                           RTCHitN_primID(hits, width, i)};
    if (other < ids) return;
  }
  RTCRayN_tfar(rays, width, i) = found.ray.tfar[i];
  RTCHitN_u(hits, width, i) = found.hit.u[i], RTCHitN_v(hits, width, i) = found.hit.v[i];
  RTCHitN_instID(hits, width, i, 0) = ids[0], RTCHitN_geomID(hits, width, i) = ids[1];
  RTCHitN_primID(hits, width, i) = ids[2];
  embree::confirm(args, i);
}

/// `place`: the instance's map or its track.
template <int width, class Place>
void intersect_instance(const RTCIntersectFunctionNArguments* args, uint32_t object, const Place& place,
                        uint32_t lanes) {
  alignas(64) typename embree::Packets<width>::RayHit packet;
  lanes = enter<width>(place, rows_of(args), lanes, packet.ray);
  if (lanes == 0) return;
  std::fill_n(packet.hit.geomID, width, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(packet.hit.instID[0], width, RTC_INVALID_GEOMETRY_ID);
  {
    const Entered entered(*args->context, object);
    embree::intersect<width>(Valid<width>(lanes).lanes.data(), group_of(args).mesh, query_of(args), packet);
  }
  for_each_bit(lanes, [&](unsigned i) {
    if (packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) take_hit<width>(args, i, packet);
  });
}

template <int width>
[[gnu::flatten]] void intersect_packet(const RTCIntersectFunctionNArguments* args) {
  const InstanceGroup& group = group_of(args);
  const uint32_t active = active_lanes<width>(args->valid);
  for_each_bit(active, [&](unsigned i) { embree::reject(args, i); });  // until a hit is found
  if (group.places) return intersect_instance<width>(args, group.first_object, *group.places, active);
  visit_nearest_first<width>(group.clusters[args->primID], rows_of(args), active, [&](uint32_t object, uint32_t lanes) {
    intersect_instance<width>(args, object, group.all->world_from_object(object), lanes);
  });
}

template <int width, class Place>
void occlude_instance(const RTCOccludedFunctionNArguments* args, uint32_t object, const Place& place, uint32_t lanes) {
  alignas(64) typename embree::Packets<width>::Ray packet;
  lanes = enter<width>(place, rows_of(args), lanes, packet);
  if (lanes == 0) return;
  {
    const Entered entered(*args->context, object);
    embree::occluded<width>(Valid<width>(lanes).lanes.data(), group_of(args).mesh, query_of(args), packet);
  }
  for_each_bit(lanes, [&](unsigned i) {
    if (packet.tfar[i] < 0) embree::accept(args, i);
  });
}

template <int width>
[[gnu::flatten]] void occlude_packet(const RTCOccludedFunctionNArguments* args) {
  const InstanceGroup& group = group_of(args);
  const uint32_t active = active_lanes<width>(args->valid);
  for_each_bit(active, [&](unsigned i) { embree::reject(args, i); });
  if (group.places) return occlude_instance<width>(args, group.first_object, *group.places, active);
  const InstanceCluster& cluster = group.clusters[args->primID];
  const BoxTest<width> test(rows_of(args));
  for (uint32_t k = 0; k < cluster.count; ++k)
    if (const uint32_t lanes = test.enter(cluster.box_of(k), active).lanes)
      occlude_instance<width>(args, cluster.objects[k], group.all->world_from_object(cluster.objects[k]), lanes);
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  with_width(args->N, [&](auto width) { intersect_packet<width>(args); });
}

void occlude(const RTCOccludedFunctionNArguments* args) {
  with_width(args->N, [&](auto width) { occlude_packet<width>(args); });
}

}  // namespace

float reach_around_instance(const Affine3d& m) {
  constexpr double kMostMagnified = 0x1p20, kLargestScale = 0x1p40;  // cubed, a float
  const Affine3d inverted = inverse(m);
  const double magnified = max_component(abs(inverted.x) + abs(inverted.y) + abs(inverted.z));
  const double scale = max_component(max(abs(m.x), max(abs(m.y), abs(m.z))));
  const bool placed =
      magnified <= kMostMagnified && scale <= kLargestScale && max_component(abs(inverted.origin)) < embree::kReach / 2;
  return placed ? float(std::min<double>(embree::kReach, embree::kReach / 2 / magnified)) : 0;
}

float reach_around_instance(const Track<Affine3d>& track) {
  const auto size = [](const Affine3d& m) { return max_component(abs(m.x) + abs(m.y) + abs(m.z)); };
  float reach = embree::kReach;
  for (size_t k = 0; k < track.size(); ++k) {
    const Affine3d &m = track[k], &next = track[std::min(k + 1, track.size() - 1)];
    // What is added to m on the way to the next is so much less that inverses stay within twice that of m.
    const Affine3d added{next.x - m.x, next.y - m.y, next.z - m.z, {}};
    if (!(size(added) * size(inverse(m)) <= 0.5)) return 0;
    reach = std::min(reach, reach_around_instance(m) / 2);
  }
  return reach;
}

uint32_t group_size(const Geometry& geometry, uint32_t object) {
  const MeshInstances& placed = geometry.mesh_instances;
  const uint32_t mesh = placed.mesh_of(object);
  uint32_t end = object;
  while (end < placed.size() && placed.mesh_of(end) == mesh && !track_of_object(geometry, end)) ++end;
  return end - object;
}

RTCGeometry new_instance_geometry(RTCDevice device, InstanceGroup& group) {
  if (!group.places)
    group.clusters = cluster_instances(*group.all, group.first_object, group.count, mesh_box(group.mesh));
  return new_user_geometry(device, {.primitives = group.places ? 1 : group.clusters.size(),
                                    .time_steps = group.places ? group.places->size() : 1,
                                    .data = &group,
                                    .bounds = bound,
                                    .intersect = intersect,
                                    .occluded = occlude});
}

}  // namespace alhazen
