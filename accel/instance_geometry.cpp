#include "accel/instance_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "accel/posed.h"
#include "accel/user_geometry.h"

namespace alhazen {
namespace {

const InstanceGroup& group_of(const void* data) { return *static_cast<const InstanceGroup*>(data); }

/// A box around the instance, larger by what float traversal of it may err. Linear between two poses, for the mesh's
/// own box holds it at all times.
void bound(const RTCBoundsFunctionArguments* args) {
  const InstanceGroup& group = group_of(args->geometryUserPtr);
  RTCBounds box;
  rtcGetSceneBounds(group.mesh, &box);
  const Bounds3d object{{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}};
  const Affine3d& m = group.places ? (*group.places)[args->timeStep] : group.first[args->primID].world_from_object;
  const Bounds3d world = transform_bounds(m, object);
  const Vec3d reach = max(abs(object.lower), abs(object.upper));
  const Vec3d margin = (abs(m.x) * reach.x + abs(m.y) * reach.y + abs(m.z) * reach.z + abs(m.origin)) * 0x1p-20;
  write_bounds(args, {world.lower - margin, world.upper + margin});
}

bool within_reach(const Vec3f& v) { return max_component(abs(v)) < embree::kReach; }

/// The lanes of a callback's packet in the space of the mesh; the direction is not made unit length, so t is shared.
/// Rays out of reach there miss, and those at a time when the instance has no extent.
template <int width, class Ray>
void enter(const InstanceGroup& group, unsigned primitive, RTCRayN* from, unsigned n, const int* active, int* valid,
           Ray& ray) {
  for (unsigned i = 0; i < unsigned(width); ++i) valid[i] = i < n ? active[i] : 0;
  Affine3f object_from_world;
  if (!group.places) object_from_world = Affine3f(inverse(group.first[primitive].world_from_object));
  for (unsigned i = 0; i < n; ++i) {
    if (!valid[i]) continue;
    if (group.places) {
      const Affine3d then = at_time(*group.places, RTCRayN_time(from, n, i));
      if (!is_invertible(then)) {
        valid[i] = 0;
        continue;
      }
      object_from_world = Affine3f(inverse(then));
    }
    const Vec3f o = transform_point(
        object_from_world, Vec3f{RTCRayN_org_x(from, n, i), RTCRayN_org_y(from, n, i), RTCRayN_org_z(from, n, i)});
    const Vec3f d = transform_vector(
        object_from_world, Vec3f{RTCRayN_dir_x(from, n, i), RTCRayN_dir_y(from, n, i), RTCRayN_dir_z(from, n, i)});
    if (!within_reach(o) || !within_reach(d)) {
      valid[i] = 0;
      continue;
    }
    ray.org_x[i] = o.x, ray.org_y[i] = o.y, ray.org_z[i] = o.z;
    ray.dir_x[i] = d.x, ray.dir_y[i] = d.y, ray.dir_z[i] = d.z;
    ray.tnear[i] = RTCRayN_tnear(from, n, i), ray.tfar[i] = RTCRayN_tfar(from, n, i);
    ray.time[i] = RTCRayN_time(from, n, i), ray.mask[i] = RTCRayN_mask(from, n, i);
    ray.id[i] = RTCRayN_id(from, n, i), ray.flags[i] = RTCRayN_flags(from, n, i);
  }
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

template <int width>
void intersect_packet(const RTCIntersectFunctionNArguments* args) {
  const InstanceGroup& group = group_of(args->geometryUserPtr);
  const unsigned n = args->N;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
  alignas(64) int valid[width];
  alignas(64) typename embree::Packets<width>::RayHit packet;
  enter<width>(group, args->primID, rays, n, args->valid, valid, packet.ray);
  std::fill_n(packet.hit.geomID, width, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(packet.hit.instID[0], width, RTC_INVALID_GEOMETRY_ID);
  {
    const Entered entered(*args->context, group.first_object + args->primID);
    embree::intersect<width>(valid, group.mesh, query_of(args), packet);
  }
  for (unsigned i = 0; i < n; ++i) {
    if (!args->valid[i]) continue;
    if (!valid[i] || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
      embree::reject(args, i);
      continue;
    }
    RTCRayN_tfar(rays, n, i) = packet.ray.tfar[i];
    RTCHitN_u(hits, n, i) = packet.hit.u[i], RTCHitN_v(hits, n, i) = packet.hit.v[i];
    RTCHitN_geomID(hits, n, i) = packet.hit.geomID[i], RTCHitN_primID(hits, n, i) = packet.hit.primID[i];
    RTCHitN_instID(hits, n, i, 0) = packet.hit.instID[0][i];
    embree::confirm(args, i);
  }
}

template <int width>
void occlude_packet(const RTCOccludedFunctionNArguments* args) {
  const InstanceGroup& group = group_of(args->geometryUserPtr);
  alignas(64) int valid[width];
  alignas(64) typename embree::Packets<width>::Ray packet;
  enter<width>(group, args->primID, args->ray, args->N, args->valid, valid, packet);
  {
    const Entered entered(*args->context, group.first_object + args->primID);
    embree::occluded<width>(valid, group.mesh, query_of(args), packet);
  }
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    if (valid[i] && packet.tfar[i] < 0)
      embree::accept(args, i);
    else
      embree::reject(args, i);
  }
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  args->N <= 4 ? intersect_packet<4>(args) : args->N <= 8 ? intersect_packet<8>(args) : intersect_packet<16>(args);
}

void occlude(const RTCOccludedFunctionNArguments* args) {
  args->N <= 4 ? occlude_packet<4>(args) : args->N <= 8 ? occlude_packet<8>(args) : occlude_packet<16>(args);
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
  const std::vector<MeshInstance>& placed = geometry.mesh_instances;
  uint32_t end = object;
  while (end < placed.size() && placed[end].mesh == placed[object].mesh && !track_of_object(geometry, end)) ++end;
  return end - object;
}

RTCGeometry new_instance_geometry(RTCDevice device, const InstanceGroup& group) {
  return new_user_geometry(device, {.primitives = group.count,
                                    .time_steps = group.places ? group.places->size() : 1,
                                    .data = &group,
                                    .bounds = bound,
                                    .intersect = intersect,
                                    .occluded = occlude});
}

}  // namespace alhazen
