// A planar polygon with holes, of any orientation: the points of a plane that are inside of its loops by the even-odd
// rule.
//
// Everything is decided in the projection along the axis in which the normal is largest (the first of x, y, z among
// equals): a plane is a height over the other two coordinates. Which points are inside is half-open: a point exactly
// on an edge belongs to the side of greater coordinates, so that of polygons that tile a plane exactly one owns each
// point, their edges and vertices included.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "accel/line.h"
#include "core/ray.h"
#include "core/vec.h"

namespace alhazen {

/// The plane z = offset + slope_x x + slope_y y, |slopes| <= 1. Exact as Rational; as binary128 good to 2^-110,
/// relatively.
template <class N>
struct HeightPlane {
  N slope_x{}, slope_y{}, offset{};
};

/// Made by `make_polygon`. Plane coordinates (x, y, z) are those of space less `center`, in the cyclic order that puts
/// the dropped axis last.
struct Polygon {
  /// Ends in plane coordinates, rounded to double, and as indices of `vertices`, which are exact.
  struct Edge {
    double x0, y0, x1, y1;
    double span;  // |x1 - x0| + |y1 - y0|
    uint32_t first, second;
  };

  std::vector<Vec3d> vertices;  // of all loops, one after the other
  int dropped_axis = 2;
  Vec3d center;               // near the mean of the first loop's vertices
  HeightPlane<double> plane;  // in plane coordinates
  HeightPlane<Quad> quad_plane;
  HeightPlane<Rational> exact_plane;  // through the exact mean of the first loop's vertices, by its exact normal
  Vec3d unit_normal;
  double radius = 0;               // no vertex has larger |x| or |y|
  double height = 0;               // no point of the polygon has larger |z|
  Vec3d u_direction, v_direction;  // gradients of the texture coordinates, per unit of length
  Vec2d uv_origin;                 // texture coordinates at the center
  double u_length = 0;             // of [0, 1] in u

  // Edges grouped by strips of equal height in y: strip s holds edges[strips[s] .. strips[s + 1]), all that come
  // within `strip_margin` of it.
  std::vector<Edge> edges;
  std::vector<uint32_t> strips;
  double strips_lower = 0, strips_per_y = 0, strip_margin = 0;
};

/// Why loops do not make a polygon: what() says what was found and what is expected.
struct PolygonError : std::invalid_argument {
  PolygonError(size_t loop_index, const std::string& reason) : std::invalid_argument(reason), loop(loop_index) {}
  size_t loop;
};

/// The polygon with these loops of finite vertices, each closed from its last vertex to its first. The plane goes
/// through the mean of the first loop's vertices; its normal is Newell's of the first loop, right-handed. Vertices off
/// the plane are moved into it along the dropped axis. Loops may touch, cross or repeat themselves and each other.
///
/// errors  PolygonError for no loop, a loop with fewer than 3 distinct points or only collinear ones, a first loop
///         whose normal is 0, and a vertex further from the plane than 1e-4 of the longest side of the box around all
///         vertices. All of this is decided exactly.
/// source  normal: Newell's method, Sutherland, Sproull and Schumacker, ACM Computing Surveys 6(1), 1974.
[[nodiscard]] Polygon make_polygon(const std::vector<std::vector<Vec3d>>& loops);

/// Where a line crosses the polygon: at most once, in at[0], from either side. A line within the plane does not.
///
/// accuracy  the exact parameter lies within the error given; `doubtful` where the line passes an edge, or runs along
///           the plane, too closely to tell, and for NaN and overflow. For T = DoubleLanes, double and Quad.
/// source    crossing parity, half-open: Schirra, How Reliable Are Practical Point-in-Polygon Strategies?, ESA 2008;
///           error bounds after Higham, Accuracy and Stability of Numerical Algorithms (2002), ch. 3.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Polygon& polygon, const ObjectLine<T>& line);

/// The same, exactly, for a finite line: none or one. A zero direction crosses nothing.
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Polygon& polygon, const ExactLine& line);

/// Rounded outward: every point of the polygon is inside.
[[nodiscard]] Bounds3d bounds(const Polygon& polygon);

/// The point of the plane nearest to `p_object`.
[[nodiscard]] Vec3d project(const Polygon& polygon, const Vec3d& p_object, int face);

/// The unit normal, the same everywhere.
[[nodiscard]] Vec3d normal(const Polygon& polygon, const Vec3d& p_object, int face);

/// u grows along the first loop's first edge (the first that has a length), v down along -n x u; the extent of all
/// loops is [0, 1]².
[[nodiscard]] Vec2f texture_coordinates(const Polygon& polygon, const Vec3d& p_object, int face);

/// ∂p/∂u.
[[nodiscard]] Vec3d u_tangent(const Polygon& polygon, const Vec3d& p_object, int face);

}  // namespace alhazen
