// Rays of a packet, as the callbacks of user geometries read and write them.
#pragma once

#include <array>
#include <bit>

#include "accel/embree.h"
#include "accel/line.h"
#include "accel/ray_rows.h"

namespace alhazen {

inline constexpr unsigned kLanes = unsigned(DoubleLanes::size());
inline constexpr int kFewLanes = 2;  // no more than these are faster one by one

/// Calls f(k) for each bit k that is set.
template <class F>
void for_each_bit(uint32_t bits, const F& f) {
  for (; bits != 0; bits &= bits - 1) f(unsigned(std::countr_zero(bits)));
}

/// Calls few(k) for each of the lanes whose bit is set, or many(first, bits) for each group of kLanes that holds some
/// of them: what takes less.
template <class Few, class Many>
void for_lanes(uint32_t lanes, unsigned width, const Few& few, const Many& many) {
  if (std::popcount(lanes) <= kFewLanes || width % kLanes != 0) return for_each_bit(lanes, few);
  for (unsigned first = 0; first < width; first += kLanes)
    if (const uint32_t bits = lanes >> first & ((1u << kLanes) - 1)) many(first, bits);
}

inline RayRows rows_of(const RTCIntersectFunctionNArguments* args) {
  return {&RTCRayN_org_x(RTCRayHitN_RayN(args->rayhit, args->N), args->N, 0), args->N};
}
inline RayRows rows_of(const RTCOccludedFunctionNArguments* args) {
  return {&RTCRayN_org_x(args->ray, args->N, 0), args->N};
}

/// Lanes [first, first + kLanes) of a packet in double.
struct PacketLanes {
  Vec3<DoubleLanes> origin, direction;
  DoubleLanes t_min, t_max;

  PacketLanes(const RayRows& rays, unsigned first) {
    const auto load = [&](const float* row) { return DoubleLanes(row + first, std::experimental::element_aligned); };
    origin = {load(rays.origin(0)), load(rays.origin(1)), load(rays.origin(2))};
    direction = {load(rays.direction(0)), load(rays.direction(1)), load(rays.direction(2))};
    t_min = load(rays.t_min()), t_max = load(rays.t_max());
  }
};

/// Takes a hit into lane `i`, unless one at the same distance has the smaller (instance, geometry, primitive): which
/// one is met first must not depend on the order of traversal.
inline void take(const RTCIntersectFunctionNArguments* args, unsigned i, float t, float u, float v) {
  const unsigned n = args->N;
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, n);
  if (t == RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, n), n, i) &&
      RTCHitN_geomID(hit, n, i) != RTC_INVALID_GEOMETRY_ID) {
    const std::array other{RTCHitN_instID(hit, n, i, 0), RTCHitN_geomID(hit, n, i), RTCHitN_primID(hit, n, i)};
    if (other <= std::array{args->context->instID[0], args->geomID, args->primID}) return;
  }
  embree::accept(args, i, t);
  RTCHitN_u(hit, n, i) = u, RTCHitN_v(hit, n, i) = v;
}

using LaneFloats = std::array<float, kLanes>;

inline LaneFloats floats_of(const DoubleLanes& x) {
  LaneFloats floats;
  x.copy_to(floats.data(), std::experimental::element_aligned);
  return floats;
}

/// The same for the lanes first + k whose bit k is set. Plain loops over rows, which compilers turn into masked stores.
inline void take_lanes(const RTCIntersectFunctionNArguments* args, unsigned first, uint32_t bits, const LaneFloats& t,
                       const LaneFloats& u, const LaneFloats& v) {
  using Row = FloatLanes<int(kLanes)>;
  const unsigned n = args->N;
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, n);
  float* t_far = &RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, n), n, first);
  const uint32_t ties =
      lane_bits(Row(t.data(), std::experimental::element_aligned) == Row(t_far, std::experimental::element_aligned));
  if (std::popcount(bits) <= kFewLanes || (bits & ties) != 0)
    return for_each_bit(bits, [&](unsigned k) { take(args, first + k, t[k], u[k], v[k]); });
  float *u_row = &RTCHitN_u(hit, n, first), *v_row = &RTCHitN_v(hit, n, first);
  unsigned *geometry = &RTCHitN_geomID(hit, n, first), *primitive = &RTCHitN_primID(hit, n, first),
           *instance = &RTCHitN_instID(hit, n, first, 0);
  const unsigned geometry_id = args->geomID, primitive_id = args->primID, instance_id = args->context->instID[0];
  for (unsigned k = 0; k < kLanes; ++k) {
    const bool taken = (bits >> k & 1) != 0;
    t_far[k] = taken ? t[k] : t_far[k], u_row[k] = taken ? u[k] : u_row[k], v_row[k] = taken ? v[k] : v_row[k];
    geometry[k] = taken ? geometry_id : geometry[k], primitive[k] = taken ? primitive_id : primitive[k];
    instance[k] = taken ? instance_id : instance[k];
  }
  for_each_bit(bits, [&](unsigned k) { embree::confirm(args, first + k); });
}

}  // namespace alhazen
