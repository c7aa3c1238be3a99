// Embree 3.13 and Embree 4 under one set of names. Included by sources of accel/ and, for the baselines, by the
// benches; nothing else depends on which of the two was found.
//
// What differs and is settled here: the include folder, where a query's flags and callback data go, the order of a
// query's arguments, how a user geometry says that a lane was hit, and the mask of a new geometry. Embree 4 says so in
// its "Embree API Reference", chapter "Upgrading from Embree 3 to Embree 4".
#pragma once

#if ALHAZEN_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstring>
#include <limits>

#include "accel/wave.h"

namespace alhazen::embree {

#if ALHAZEN_EMBREE_MAJOR >= 4
using CallbackContext = RTCRayQueryContext;
#else
using CallbackContext = RTCIntersectContext;
#endif

/// One query: what traversal should expect of its rays, and what its callbacks are handed. Derive from it to give the
/// callbacks data of their own.
struct Query {
  CallbackContext context;  // first, so that the pointer a callback receives leads back here
  Coherence coherence;

  explicit Query(Coherence rays) : coherence(rays) {
#if ALHAZEN_EMBREE_MAJOR >= 4
    rtcInitRayQueryContext(&context);
#else
    rtcInitIntersectContext(&context);
    context.flags =
        rays == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif
  }
};

/// The query, of the caller's type, that a callback with these arguments serves.
template <class DerivedQuery, class CallbackArguments>
[[nodiscard]] const DerivedQuery& query_of(const CallbackArguments* arguments) {
  return *static_cast<const DerivedQuery*>(reinterpret_cast<const Query*>(arguments->context));
}

inline constexpr unsigned kEveryRay = ~0u;  // mask of all our rays and geometries

/// The types and calls of the packets of one width.
template <int width>
struct Packets;

/// One ray in the same words: a single lane is laid out as Embree's ray.
template <>
struct Packets<1> {
  using Ray = RTCRayNt<1>;
  using RayHit = RTCRayHitNt<1>;
#if ALHAZEN_EMBREE_MAJOR >= 4
  static void intersect(const int* valid, RTCScene scene, RayHit* ray, RTCIntersectArguments* arguments) {
    if (*valid) rtcIntersect1(scene, reinterpret_cast<RTCRayHit*>(ray), arguments);
  }
  static void occluded(const int* valid, RTCScene scene, Ray* ray, RTCOccludedArguments* arguments) {
    if (*valid) rtcOccluded1(scene, reinterpret_cast<RTCRay*>(ray), arguments);
  }
#else
  static void intersect(const int* valid, RTCScene scene, CallbackContext* context, RayHit* ray) {
    if (*valid) rtcIntersect1(scene, context, reinterpret_cast<RTCRayHit*>(ray));
  }
  static void occluded(const int* valid, RTCScene scene, CallbackContext* context, Ray* ray) {
    if (*valid) rtcOccluded1(scene, context, reinterpret_cast<RTCRay*>(ray));
  }
#endif
};

template <>
struct Packets<4> {
  using Ray = RTCRay4;
  using RayHit = RTCRayHit4;
  static constexpr auto intersect = rtcIntersect4;
  static constexpr auto occluded = rtcOccluded4;
};

template <>
struct Packets<8> {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
  static constexpr auto intersect = rtcIntersect8;
  static constexpr auto occluded = rtcOccluded8;
};

template <>
struct Packets<16> {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
  static constexpr auto intersect = rtcIntersect16;
  static constexpr auto occluded = rtcOccluded16;
};

#if ALHAZEN_EMBREE_MAJOR >= 4
[[nodiscard]] inline RTCRayQueryFlags query_flags(Coherence rays) {
  return rays == Coherence::coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
#endif

/// Rays of the wave from `first` on into a packet of that width. A ray's id is its number in the wave.
template <class Packet>
void load_rays(const RayWave& wave, size_t first, int width, Packet& ray) {
  const size_t bytes = size_t(width) * sizeof(float);
  std::memcpy(ray.org_x, &wave.origin.x[first], bytes), std::memcpy(ray.org_y, &wave.origin.y[first], bytes);
  std::memcpy(ray.org_z, &wave.origin.z[first], bytes), std::memcpy(ray.dir_x, &wave.direction.x[first], bytes);
  std::memcpy(ray.dir_y, &wave.direction.y[first], bytes), std::memcpy(ray.dir_z, &wave.direction.z[first], bytes);
  std::memcpy(ray.tnear, &wave.t_min[first], bytes), std::memcpy(ray.tfar, &wave.t_max[first], bytes);
  for (int i = 0; i < width; ++i)
    ray.time[i] = 0, ray.mask[i] = kEveryRay, ray.flags[i] = 0, ray.id[i] = unsigned(first) + unsigned(i);
  if (wave.time.size() > 0) std::memcpy(ray.time, &wave.time[first], bytes);
}

/// The closest hits of the lanes whose `valid` is -1. `valid` and `packet` are aligned to the packet's size.
template <int width>
void intersect(const int* valid, RTCScene scene, Query& query, typename Packets<width>::RayHit& packet) {
#if ALHAZEN_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = query_flags(query.coherence), arguments.context = &query.context;
  Packets<width>::intersect(valid, scene, &packet, &arguments);
#else
  Packets<width>::intersect(valid, scene, &query.context, &packet);
#endif
}

/// Sets tfar to -infinity in the lanes whose `valid` is -1 and whose segment is blocked.
template <int width>
void occluded(const int* valid, RTCScene scene, Query& query, typename Packets<width>::Ray& packet) {
#if ALHAZEN_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = query_flags(query.coherence), arguments.context = &query.context;
  Packets<width>::occluded(valid, scene, &packet, &arguments);
#else
  Packets<width>::occluded(valid, scene, &query.context, &packet);
#endif
}

// ---- A user geometry's verdict on a lane: every active lane gets exactly one. ----

/// The ray misses the primitive. Embree 4 reads the verdict in `valid`; Embree 3 wants `valid` left alone.
template <class CallbackArguments>
void reject([[maybe_unused]] const CallbackArguments* arguments, [[maybe_unused]] unsigned lane) {
#if ALHAZEN_EMBREE_MAJOR >= 4
  arguments->valid[lane] = 0;
#endif
}

/// The lane's hit has been written.
inline void confirm([[maybe_unused]] const RTCIntersectFunctionNArguments* arguments, [[maybe_unused]] unsigned lane) {
#if ALHAZEN_EMBREE_MAJOR >= 4
  arguments->valid[lane] = -1;
#endif
}

/// The ray hits the primitive at `t`, closer than whatever the lane held.
inline void accept(const RTCIntersectFunctionNArguments* arguments, unsigned lane, float t) {
  const unsigned n = arguments->N;
  RTCHitN* hit = RTCRayHitN_HitN(arguments->rayhit, n);
  RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, n), n, lane) = t;
  RTCHitN_u(hit, n, lane) = RTCHitN_v(hit, n, lane) = 0;
  RTCHitN_geomID(hit, n, lane) = arguments->geomID;
  RTCHitN_primID(hit, n, lane) = arguments->primID;
  RTCHitN_instID(hit, n, lane, 0) = arguments->context->instID[0];
  confirm(arguments, lane);
}

/// The primitive blocks the ray.
inline void accept(const RTCOccludedFunctionNArguments* arguments, unsigned lane) {
  RTCRayN_tfar(arguments->ray, arguments->N, lane) = -std::numeric_limits<float>::infinity();
#if ALHAZEN_EMBREE_MAJOR >= 4
  arguments->valid[lane] = -1;
#endif
}

// ---- Devices and geometries ----

/// What each coordinate of a ray's origin and direction must stay below, in every space that it is traversed in: one
/// beyond ends the program where Embree's assertions are on.
inline constexpr float kReach = 1.8e18f;

/// A geometry that every ray sees. Embree 3 gives new geometries all mask bits, Embree 4 the lowest one alone.
[[nodiscard]] inline RTCGeometry new_geometry(RTCDevice device, RTCGeometryType type) {
  RTCGeometry geometry = rtcNewGeometry(device, type);
  rtcSetGeometryMask(geometry, kEveryRay);
  return geometry;
}

/// Lanes that the device traverses together: 4, 8 or 16.
[[nodiscard]] inline int packet_width(RTCDevice device) {
  return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)  ? 16
         : rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8
                                                                                   : 4;
}

/// Whether a coherent rtcOccluded16 on a scene with instances may never return after an incoherent 16-wide query on the
/// same thread. Seen on AVX-512 with 3.13.5 as g++ 12 compiles it, not with 4.4.1, which masks the lane bits.
inline constexpr bool kCoherentOccluded16HangsOnInstances = RTC_VERSION < 40401;

}  // namespace alhazen::embree
