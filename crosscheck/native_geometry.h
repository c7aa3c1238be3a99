// Embree's own geometries for surfaces, and how their hits read.
#pragma once

#include "crosscheck/embree_scene.h"
#include "crosscheck/party.h"

namespace alhazen::crosscheck {

/// Embree's nearest geometry in the surface's own space, not yet committed; null where there is none.
[[nodiscard]] RTCGeometry new_native_geometry(RTCDevice device, const Surface& surface);

/// Within an instance rays must not overflow Embree's numbers. Its cones take |direction| = 1 for granted.
[[nodiscard]] bool native_is_for(const Surface& surface, const Affine3d& object_from_world, const Rayf& ray_world);

/// What one lane of a packet says of the surface.
template <class Hit>
[[nodiscard]] Answer native_answer(const Surface& surface, const Hit& hit, size_t lane, float t) {
  Answer answer;
  answer.hit = true, answer.t = t;
  if (std::holds_alternative<Box>(surface)) answer.face = int(hit.primID[lane] / 2);
  const Vec3d normal{double(hit.Ng_x[lane]), double(hit.Ng_y[lane]), double(hit.Ng_z[lane])};
  answer.native = {normalize(normal), std::holds_alternative<Triangle>(surface), hit.u[lane], hit.v[lane]};
  return answer;
}

}  // namespace alhazen::crosscheck
