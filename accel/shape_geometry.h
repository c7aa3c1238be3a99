// Analytic shapes as Embree user geometry: one geometry for each kind of shape, one packet callback for each query.
#pragma once

#include <memory>
#include <vector>

#include "accel/embree.h"
#include "accel/geometry.h"
#include "accel/shape_hits.h"
#include "accel/surface_filter.h"

namespace alhazen {

/// A query whose shadow rays gather what the surfaces that they cross let through.
struct WaveQuery : embree::Query {
  Rgb* visible;  // by ray id; shadow queries only

  WaveQuery(Coherence rays, Rgb* visible_by_ray) : embree::Query(rays), visible(visible_by_ray) {}
};

/// Placed shapes of one kind, as their callbacks read them. A hit's face is in its u.
struct ShapeGroup {
  struct Member {
    PlacedShape placed;
    uint32_t object;  // Geometry's object number
    Opacity opacity;
  };
  SurfaceFilter filter;
  std::vector<Member> members;
};

/// The scene's shapes by kind; kinds without members are left out. Throws `Error` naming the node of a shape that
/// reaches further than traversal can hold.
[[nodiscard]] std::vector<std::unique_ptr<ShapeGroup>> group_shapes(const Geometry& geometry,
                                                                    const SurfaceFilter& filter);

/// A committed user geometry over the group, which must outlive it.
[[nodiscard]] RTCGeometry new_shape_geometry(RTCDevice device, const ShapeGroup& group);

}  // namespace alhazen
