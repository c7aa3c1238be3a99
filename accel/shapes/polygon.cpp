#include <algorithm>
#include <cmath>
#include <type_traits>

#include "accel/shapes/polygon_plane.h"

namespace alhazen {
namespace {

/// Products below this may have lost digits to underflow: no bound may be smaller.
constexpr double kUnderflow = 0x1p-800;

using ExactVec = Vec3<Rational>;

template <class T>
struct Bounded {
  T value, error;  // the exact value lies within `error`
};

/// A point of the plane, within `error` in x and in y.
template <class T>
struct PlanePoint {
  T x, y, error;
};

template <class T>
struct Inside {
  MaskOf<T> odd{false}, doubtful{false};
};

/// The plane as T takes it.
template <class T>
const auto& plane_of(const Polygon& polygon) {
  if constexpr (std::is_same_v<T, Quad>)
    return polygon.quad_plane;
  else
    return polygon.plane;
}

template <class T>
T largest(const Vec3<T>& v) {
  return larger(absolute(v.x), larger(absolute(v.y), absolute(v.z)));
}

/// The line in plane coordinates.
template <class T>
ObjectLine<T> in_plane_coordinates(const Polygon& polygon, const ObjectLine<T>& line) {
  const int axis = polygon.dropped_axis;
  const double u = kUnitRoundoff<T>;
  const Vec3<T> o = to_plane_axes(line.origin - Vec3<T>(polygon.center), axis);
  const Vec3<T> error = to_plane_axes(line.origin_error, axis);
  return {o,
          to_plane_axes(line.direction, axis),
          {error.x + absolute(o.x) * (2 * u), error.y + absolute(o.y) * (2 * u), error.z + absolute(o.z) * (2 * u)},
          to_plane_axes(line.direction_error, axis)};
}

/// v.z - slope_x v.x - slope_y v.y.
template <class T>
Bounded<T> rise(const Polygon& polygon, const Vec3<T>& v, const Vec3<T>& v_error) {
  const double u = kUnitRoundoff<T>;
  const T sx(plane_of<T>(polygon).slope_x), sy(plane_of<T>(polygon).slope_y);
  return {v.z - (sx * v.x + sy * v.y), (v_error.z + absolute(v.z) * (16 * u)) +
                                           (v_error.x + absolute(v.x) * (16 * u)) * absolute(sx) +
                                           (v_error.y + absolute(v.y) * (16 * u)) * absolute(sy) + kUnderflow};
}

/// Whether a line nearly parallel to the plane stays clear of it for as long as it is near the polygon.
template <class T>
MaskOf<T> stays_clear(const Polygon& polygon, const ObjectLine<T>& line, const Bounded<T>& height,
                      const Bounded<T>& speed) {
  const T gap = absolute(height.value) - height.error;
  const T stride = largest(line.direction) - largest(line.direction_error);
  const T way = largest(line.origin) + largest(line.origin_error) + T(std::max(polygon.radius, polygon.height));
  return (gap > T(0)) && (stride > T(0)) && (gap * stride > (absolute(speed.value) + speed.error) * way * 1.01);
}

template <class T>
PlanePoint<T> point_at(const Polygon& polygon, const ObjectLine<T>& line, const Bounded<T>& t) {
  const double u = kUnitRoundoff<T>;
  const T size = absolute(t.value) + t.error;
  const auto error = [&](const T& o, const T& d, const T& o_error, const T& d_error) {
    return o_error + size * d_error + absolute(d) * t.error + (absolute(o) + size * absolute(d)) * (4 * u);
  };
  const T x_error = error(line.origin.x, line.direction.x, line.origin_error.x, line.direction_error.x);
  const T y_error = error(line.origin.y, line.direction.y, line.origin_error.y, line.direction_error.y);
  // The last term is for the vertices, rounded too, and for what follows.
  return {line.origin.x + t.value * line.direction.x, line.origin.y + t.value * line.direction.y,
          larger(x_error, y_error) + polygon.radius * (8 * u) + kUnderflow};
}

template <class T>
struct EdgeEnds {
  T x0, y0, x1, y1;
};

template <class T>
EdgeEnds<T> ends_of(const Polygon& polygon, const Polygon::Edge& edge) {
  if constexpr (std::is_same_v<T, Quad>) {
    const auto at = [&](uint32_t i) {
      return to_plane_axes(Vec3<Quad>(polygon.vertices[i]) - Vec3<Quad>(polygon.center), polygon.dropped_axis);
    };
    const Vec3<Quad> p = at(edge.first), q = at(edge.second);
    return {p.x, p.y, q.x, q.y};
  } else {
    return {T(edge.x0), T(edge.y0), T(edge.x1), T(edge.y1)};
  }
}

/// The parity of the edges of strip `strip` that run to the right of `p`, towards greater x. Doubtful where one comes
/// within the point's error: only there can the parity of the exact point be another.
template <class T>
Inside<T> inside_strip(const Polygon& polygon, size_t strip, const PlanePoint<T>& p) {
  Inside<T> inside;
  const T e2 = p.error * 2, e3 = p.error * 3, e6 = p.error * 6;
  for (uint32_t i = polygon.strips[strip]; i < polygon.strips[strip + 1]; ++i) {
    const Polygon::Edge& edge = polygon.edges[i];
    const EdgeEnds<T> ends = ends_of<T>(polygon, edge);
    const T x0 = ends.x0 - p.x, y0 = ends.y0 - p.y, x1 = ends.x1 - p.x, y1 = ends.y1 - p.y;
    const MaskOf<T> above0 = y0 > T(0), above1 = y1 > T(0), in_rows = above0 != above1;
    const T area = x0 * y1 - x1 * y0;
    inside.odd = inside.odd != (in_rows && ((area > T(0)) == above1));
    // The edge's line comes within the error only where the area is within the first bound; the edge itself, if its
    // box comes near as well. Far from the box nothing cancels, so there underflow alone can hide the area's sign.
    const MaskOf<T> close = !(absolute(area) > e3 * (T(edge.span) + e6) + kUnderflow);
    if (any_of(close)) [[unlikely]] {
      const MaskOf<T> far =
          (absolute(x0 + x1) > absolute(x1 - x0) + e2) || (absolute(y0 + y1) > absolute(y1 - y0) + e2);
      inside.doubtful = inside.doubtful || (close && (!far || (in_rows && !(absolute(area) > T(kUnderflow)))));
    }
  }
  return inside;
}

template <class T>
Inside<T> inside_of(const Polygon& polygon, const PlanePoint<T>& p) {
  if (polygon.strips.size() == 2) return inside_strip(polygon, 0, p);
  if constexpr (std::is_same_v<T, DoubleLanes>) {
    Inside<T> inside;
    for (size_t i = 0; i < T::size(); ++i) {
      const auto lane = inside_of(polygon, PlanePoint<double>{p.x[i], p.y[i], p.error[i]});
      inside.odd[i] = lane.odd, inside.doubtful[i] = lane.doubtful;
    }
    return inside;
  } else {
    if (!(p.error < polygon.strip_margin / 2)) return {false, true};
    return inside_strip(polygon, strip_of(polygon, double(p.y)), p);
  }
}

/// inside_of, exactly; p in space less the center, as the exact vertices are.
bool exactly_inside(const Polygon& polygon, const Rational& x, const Rational& y) {
  const size_t strip = strip_of(polygon, y.get_d());
  const ExactVec center = exact(polygon.center);
  bool odd = false;
  for (uint32_t i = polygon.strips[strip]; i < polygon.strips[strip + 1]; ++i) {
    const Polygon::Edge& edge = polygon.edges[i];
    const ExactVec p = to_plane_axes(exact(polygon.vertices[edge.first]) - center, polygon.dropped_axis);
    const ExactVec q = to_plane_axes(exact(polygon.vertices[edge.second]) - center, polygon.dropped_axis);
    const bool above0 = p.y > y, above1 = q.y > y;
    if (above0 == above1) continue;
    const int area = sgn(Rational((p.x - x) * (q.y - y) - (q.x - x) * (p.y - y)));
    odd = odd != (above1 ? area > 0 : area < 0);
  }
  return odd;
}

}  // namespace

template <class T>
LineCrossings<T> crossings(const Polygon& polygon, const ObjectLine<T>& line_object) {
  LineCrossings<T> out;
  const ObjectLine<T> line = in_plane_coordinates(polygon, line_object);
  const T offset(plane_of<T>(polygon).offset);
  Bounded<T> height = rise(polygon, line.origin, line.origin_error);
  height = {height.value - offset,
            height.error + (absolute(height.value) + absolute(offset)) * (16 * kUnitRoundoff<T>)};
  const Bounded<T> speed = rise(polygon, line.direction, line.direction_error);
  const MaskOf<T> steep = absolute(speed.value) > speed.error * 4;
  if (any_of(!steep)) [[unlikely]]
    out.doubtful = !steep && !stays_clear(polygon, line, height, speed);

  const T inverse = T(1) / select(steep, speed.value, T(1)), t = -(height.value * inverse);
  const T t_error =
      (height.error + absolute(t) * speed.error) * absolute(inverse) * 1.4 + absolute(t) * (4 * kUnitRoundoff<T>);
  const PlanePoint<T> p = point_at(polygon, line, Bounded<T>{t, t_error});
  // Written so that NaN is not clear of the polygon.
  const T reach = polygon.radius + p.error;
  const MaskOf<T> near = steep && !((absolute(p.x) > reach) || (absolute(p.y) > reach));
  if (!any_of(near)) return out;
  const Inside<T> inside = inside_of(polygon, p);
  out.at[0] = {t, t_error, T(kWallFace), near && inside.odd};
  out.doubtful = out.doubtful || (near && (inside.doubtful || !(t_error < HUGE_VAL)));
  return out;
}

template LineCrossings<DoubleLanes> crossings(const Polygon&, const ObjectLine<DoubleLanes>&);
template LineCrossings<double> crossings(const Polygon&, const ObjectLine<double>&);
template LineCrossings<Quad> crossings(const Polygon&, const ObjectLine<Quad>&);

std::vector<ExactCrossing> exact_crossings(const Polygon& polygon, const ExactLine& line) {
  const HeightPlane<Rational>& plane = polygon.exact_plane;
  const ExactVec o = to_plane_axes(line.origin - exact(polygon.center), polygon.dropped_axis);
  const ExactVec d = to_plane_axes(line.direction, polygon.dropped_axis);
  const Rational speed = d.z - plane.slope_x * d.x - plane.slope_y * d.y;
  if (sgn(speed) == 0) return {};
  const Rational t = (plane.offset + plane.slope_x * o.x + plane.slope_y * o.y - o.z) / speed;
  if (!exactly_inside(polygon, o.x + t * d.x, o.y + t * d.y)) return {};
  return {{Surd(t)}};
}

Bounds3d bounds(const Polygon& polygon) {
  Bounds3d box;
  for (const Vec3d& vertex : polygon.vertices) extend(box, lifted(polygon, vertex) + polygon.center);
  // Rounding moves no coordinate by more than this.
  const double size = 8 * kUnitRoundoff<double> * (polygon.height + max_component(abs(polygon.center)));
  const Vec3d margin{size, size, size};
  return {box.lower - margin, box.upper + margin};
}

Vec3d project(const Polygon& polygon, const Vec3d& p_object, int) { return nearest_in_plane(polygon, p_object); }

Vec3d normal(const Polygon& polygon, const Vec3d&, int) { return polygon.unit_normal; }

Vec2f texture_coordinates(const Polygon& polygon, const Vec3d& p_object, int) {
  const Vec2d uv = uv_in_plane(polygon, p_object);
  return {float(uv.x), float(uv.y)};
}

Vec3d u_tangent(const Polygon& polygon, const Vec3d&, int) { return normalize(polygon.u_direction) * polygon.u_length; }

}  // namespace alhazen
