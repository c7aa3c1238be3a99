// Polygon meshes: the extension FB_ngon_encoding.
#pragma once

#include "accel/geometry.h"

namespace alhazen {

/// Makes polygons of the part's triangles: consecutive ones with the same first index are one, a fan from that vertex.
/// Fills `polygon_of_triangle` and, where the part has no normals, `polygon_normals`; leaves both empty where every
/// polygon is a triangle. The triangles of concave polygons are made anew: as many, of the same vertices.
///
/// Triangles that share their first vertex but are no fan stay as they are, under one number; so do fans that cross
/// themselves or have no area. Positions and triangles must be in range.
void join_polygons(TriangleMesh& part);

}  // namespace alhazen
