// Meshes as Embree user geometry over the watertight triangle: decisions as of exact arithmetic, t rounded once, where
// Embree's own triangles are as good as floats allow.
#pragma once

#include <span>

#include "accel/embree.h"
#include "accel/geometry.h"
#include "accel/surface_filter.h"

namespace alhazen {

/// A part of a mesh, as its callbacks read it. What it refers to must outlive it.
struct TriangleGroup {
  const TriangleMesh& part;
  uint32_t part_index;
  uint32_t object;  // Geometry's object number, where the part is not instanced
  Opacity opacity;
  const SurfaceFilter& filter;
  const Track<MeshPose>* track;  // of its mesh, null where that keeps its form
};

/// A committed user geometry over the group, which must outlive it. Hits are those of Embree's triangles: u and v weigh
/// the second and third vertex. Triangles without area, or with vertices beyond ±1.8e18, are never hit.
[[nodiscard]] RTCGeometry new_triangle_geometry(RTCDevice device, const TriangleGroup& group);

}  // namespace alhazen
