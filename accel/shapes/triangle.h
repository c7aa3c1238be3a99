// The triangle, three ways: two textbook intersectors in plain double, kept as they are taught, and one that decides
// every case, so that closed meshes have no leaks.
#pragma once

#include <optional>
#include <vector>

#include "accel/line.h"
#include "core/ray.h"
#include "core/vec.h"

namespace alhazen {

/// Counter-clockwise seen from outside. Without area it is never hit.
struct Triangle {
  Vec3d a, b, c;
};

/// u and v are the barycentric weights of b and c.
struct TriangleHit {
  double t, u, v;
};

/// The textbook's first algorithm: meet the plane, then keep to the inner side of each edge (closed half-spaces).
/// Plain double: near an edge either answer may come. None outside of [t_min, t_max] and for NaN.
[[nodiscard]] std::optional<TriangleHit> intersect_by_half_spaces(const Triangle& triangle, const Rayd& ray) noexcept;

/// The textbook's second algorithm: solve origin + t direction = a + u (b - a) + v (c - a) by Cramer's rule. Closed;
/// plain double: near an edge either answer may come. None outside of [t_min, t_max] and for NaN.
///
/// source  Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, Journal of Graphics Tools 2(1), 1997.
[[nodiscard]] std::optional<TriangleHit> intersect_by_cramer(const Triangle& triangle, const Rayd& ray) noexcept;

/// Where a line crosses the triangle: at most once, in at[0], from either side. A line in the triangle's plane does
/// not, nor does any line cross a triangle without area.
///
/// ties      a line that meets an edge or a vertex exactly counts as moved by an infinitely small amount along x, and
///           by ones infinitely smaller still along y and z. As one line with no ties is what all triangles answer, a
///           closed mesh is entered as often as it is left, whatever the order of its vertices.
/// accuracy  the exact parameter lies within the error given; `doubtful` where rounding leaves the side of an edge
///           open, and for NaN and overflow. For T = DoubleLanes, double and Quad.
/// source    edge functions: Woop, Benthin and Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013; ties:
///           Edelsbrunner and Mücke, Simulation of Simplicity, ACM Transactions on Graphics 9(1), 1990.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Triangle& triangle, const ObjectLine<T>& line);

/// The same, exactly, for a finite line: none or one. A zero direction crosses nothing.
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Triangle& triangle, const ExactLine& line);

}  // namespace alhazen
