// The faces of polygon meshes as triangles.
//
// A polygon mesh is traversed as triangles with a polygon's number each, not as polygons: that is what Embree is
// fastest at, its watertight test leaves no leak along the diagonals, and normals and texture coordinates need a
// triangulation to be interpolated over anyway. What the file's fans get wrong, concave faces, is put right once, when
// the mesh is loaded, by decisions that are exact: the triangles then cover the polygon and nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace alhazen {

/// Whether the triangles (0, i, i + 1) of a face all turn the same way and have an area, so that they cover it once.
/// The face is seen along the axis on which its Newell normal is largest. Exact for an outline that does not cross
/// itself; false for faces of no area.
[[nodiscard]] bool is_proper_fan(std::span<const Vec3f> corners);

/// Splits a face of n >= 3 corners into n - 2 triangles that turn as it does, as indices of its corners. All corners
/// are used and only its own edges border it, so that neighbours leave no gap. Triangles have an area wherever the face
/// leaves a choice.
///
/// none      where ear after ear gets stuck: the outline crosses itself, or encloses no area.
/// planarity a face that is not flat is split as its image along the largest axis of its Newell normal is.
/// accuracy  which corners make an ear is decided exactly on the given floats.
/// cost      about n log n for usual outlines, n sqrt(n) for combs of long thin teeth.
/// source    Meisters, Polygons Have Ears, American Mathematical Monthly 82(6), 1975; filter of the exact decisions:
///           Shewchuk, Adaptive Precision Floating-Point Arithmetic, Discrete & Computational Geometry 18, 1997.
[[nodiscard]] std::vector<std::array<uint32_t, 3>> triangulate(std::span<const Vec3f> corners);

/// Twice the vector area: its direction is the face's normal. 0 for fewer than three corners.
[[nodiscard]] Vec3d newell_normal(std::span<const Vec3f> corners);

}  // namespace alhazen
