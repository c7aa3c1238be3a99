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

/// The parameter lies within `error`; u and v, the weights of b and c, are good to double's roundings.
template <class T>
struct TriangleCrossing {
  T t{}, error{}, u{}, v{};
  MaskOf<T> present{false}, doubtful{false};
};

/// Where a line crosses the triangle: at most once, from either side. A line in the triangle's plane does
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
[[nodiscard]] TriangleCrossing<T> crossing(const Triangle& triangle, const ObjectLine<T>& line);

/// The same in the common language of shapes, in at[0].
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const TriangleCrossing<T>& found) {
  LineCrossings<T> out;
  out.at[0] = {found.t, found.error, T(kWallFace), found.present};
  out.doubtful = found.doubtful;
  return out;
}
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Triangle& triangle, const ObjectLine<T>& line) {
  return crossings(crossing(triangle, line));
}

/// Bit k: the line of lane k is not sure to pass beside the triangle, by a look in floats. The triangle's vertices and
/// the lines are exact. For N = 1, 4, 8 and 16.
template <int N>
[[nodiscard]] uint32_t lanes_that_may_cross(const Triangle& triangle, const Vec3<FloatLanes<N>>& origin,
                                            const Vec3<FloatLanes<N>>& direction);

/// The same, exactly, for a finite line: none or one. A zero direction crosses nothing.
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Triangle& triangle, const ExactLine& line);

/// The weights of b and c at a point of the triangle's plane, by the areas opposite to them.
[[nodiscard]] Vec2d weights_at(const Triangle& triangle, const Vec3d& p) noexcept;

}  // namespace alhazen
