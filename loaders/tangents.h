// Tangents for meshes that bring none.
#pragma once

#include <cstdint>

#include "accel/geometry.h"

namespace alhazen {

/// Fills `mesh.tangents` from one UV set by MikkTSpace's rules, v flipped (v' = 1 - v) as is usual for glTF: t runs
/// along +u, and cross(n, t) w against glTF's v.
///
/// Each triangle's tangent is projected into the plane of each corner's normal and weighted by the corner's angle
/// there. Corners of equal position, normal, UV and UV orientation share the sum, whether or not they share an index or
/// an edge (MikkTSpace also asks for the edge). A vertex used by both orientations is split: its copy is appended,
/// triangles keep their order. Triangles without area in space or UV contribute nothing and take what their vertex has
/// otherwise, or any perpendicular.
///
/// A mesh without normals gets flat ones first, each corner its own vertex. Nothing happens where the mesh has no such
/// UV set, or where 32-bit indices might not reach the new vertices. positions.capacity() is at least size() + 2
/// afterwards.
void generate_tangents(TriangleMesh& mesh, uint32_t uv_set);

}  // namespace alhazen
