// Analytic shapes that move while the shutter is open, as one Embree user geometry whose boxes are linear in time.
#pragma once

#include <memory>
#include <vector>

#include "accel/embree.h"
#include "accel/geometry.h"
#include "accel/surface_filter.h"

namespace alhazen {

/// Shapes of any kind with equally many poses, as the callbacks read them. A hit's face is in its u.
struct MovingShapes {
  struct Member {
    const Shape* shape;
    const Track<Affine3d>* places;
    Opacity opacity;
    uint32_t object;  // Geometry's number
  };
  SurfaceFilter filter;
  size_t poses;
  std::vector<Member> members;
};

/// Those of the scene, by their number of poses. Throws `Error` naming the node of a shape that reaches further than
/// traversal can hold.
[[nodiscard]] std::vector<std::unique_ptr<MovingShapes>> moving_shapes(const Geometry& geometry,
                                                                       const SurfaceFilter& filter);

/// A committed user geometry over the shapes, which must outlive it. Hits are those of exact arithmetic on each ray and
/// the shape's map at its time.
[[nodiscard]] RTCGeometry new_moving_geometry(RTCDevice device, const MovingShapes& shapes);

}  // namespace alhazen
