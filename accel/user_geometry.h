// What all user geometries of Embree are given alike.
#pragma once

#include "accel/embree.h"
#include "accel/traversal_bounds.h"

namespace alhazen {

/// Functions as Embree calls them for many primitives of one kind.
struct UserGeometry {
  size_t primitives = 0, time_steps = 1;
  const void* data = nullptr;  // what the functions get; must outlive the geometry
  RTCBoundsFunction bounds = nullptr;
  RTCIntersectFunctionN intersect = nullptr;
  RTCOccludedFunctionN occluded = nullptr;
};

/// Committed, and the caller's to release.
[[nodiscard]] inline RTCGeometry new_user_geometry(RTCDevice device, const UserGeometry& user) {
  RTCGeometry g = embree::new_geometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryTimeStepCount(g, unsigned(user.time_steps));
  rtcSetGeometryUserPrimitiveCount(g, unsigned(user.primitives));
  rtcSetGeometryUserData(g, const_cast<void*>(user.data));
  rtcSetGeometryBoundsFunction(g, user.bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, user.intersect);
  rtcSetGeometryOccludedFunction(g, user.occluded);
  rtcCommitGeometry(g);
  return g;
}

/// What a bounds function answers for a primitive within `box`; an empty box is never hit.
inline void write_bounds(const RTCBoundsFunctionArguments* args, const Bounds3d& box) {
  const Bounds3f b = traversal_bounds(box);
  *args->bounds_o = {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, 0};
}

}  // namespace alhazen
