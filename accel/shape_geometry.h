// Analytic shapes as Embree user geometry: one geometry for each kind of shape, one packet callback for each query.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "accel/culling_ball.h"
#include "accel/embree.h"
#include "accel/geometry.h"
#include "accel/shape_hits.h"
#include "accel/surface_filter.h"

namespace alhazen {

/// Placed shapes of one kind, as their callbacks read them. A hit's face is in its u.
struct ShapeGroup {
  struct Member {
    PlacedShape placed;
    Opacity opacity;
  };
  SurfaceFilter filter;
  std::vector<Member> members;
  std::vector<CullingBall> balls;  // by member, as what follows
  std::vector<uint32_t> objects;   // Geometry's object numbers
};

/// Those of the scene's shapes that are wanted, and stand still while the shutter is open, by kind; kinds without
/// members are left out. Throws `Error` naming the node of a shape that reaches further than traversal can hold.
[[nodiscard]] std::vector<std::unique_ptr<ShapeGroup>> group_shapes(
    const Geometry& geometry, const SurfaceFilter& filter, const std::function<bool(const ShapeInstance&)>& wanted);

/// Takes the maps from the instances as they are listed now, at the same places.
void find_instances_again(const Geometry& geometry, ShapeGroup& group);

/// A committed user geometry over the group, which must outlive it.
[[nodiscard]] RTCGeometry new_shape_geometry(RTCDevice device, const ShapeGroup& group);

}  // namespace alhazen
