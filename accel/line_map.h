// From world space to a shape's own: lines mapped with bounds on what the mapping's rounding does to them.
#pragma once

#include <span>

#include "accel/line.h"
#include "core/ray.h"
#include "core/transform.h"

namespace alhazen {

/// p_object = rows (p_world - center), N being double or Quad. The exact inverse's entries differ from the rows by at
/// most `row_error` (one number for each row) beyond a relative rounding.
template <class N>
struct LineMap {
  Vec3<N> row_x, row_y, row_z, center;
  Vec3<N> row_error;
  Vec3<N> origin_error;  // of a mapped point, from the rounding of `center`
};

/// Ready to map lines to the space that `world_from_object` leads from. Entries are taken as exact.
[[nodiscard]] LineMap<double> line_map(const Affine3d& world_from_object);
/// The same through several maps, the outermost first.
[[nodiscard]] LineMap<double> line_map(std::span<const Affine3d> chain);
[[nodiscard]] LineMap<Quad> quad_line_map(std::span<const Affine3d> chain);

/// The image of a line whose origin and direction are exact.
template <class T, class N>
[[nodiscard]] ObjectLine<T> object_line(const LineMap<N>& map, const Vec3<T>& origin, const Vec3<T>& direction) {
  const double u = 6 * kUnitRoundoff<N>;  // a subtraction, a rounded row, a sum of three products
  const Vec3<T> o{origin.x - T(map.center.x), origin.y - T(map.center.y), origin.z - T(map.center.z)};
  const T o_sum = absolute(o.x) + absolute(o.y) + absolute(o.z);
  const T d_sum = absolute(direction.x) + absolute(direction.y) + absolute(direction.z);
  ObjectLine<T> line;
  const auto axis = [&](const Vec3<N>& row, const N& row_error, const N& origin_error, T& p, T& d, T& pe, T& de) {
    const Vec3<T> r{T(row.x), T(row.y), T(row.z)};
    const T ox = r.x * o.x, oy = r.y * o.y, oz = r.z * o.z;
    const T dx = r.x * direction.x, dy = r.y * direction.y, dz = r.z * direction.z;
    p = ox + oy + oz, d = dx + dy + dz;
    pe = (absolute(ox) + absolute(oy) + absolute(oz)) * u + o_sum * T(row_error) + T(origin_error);
    de = (absolute(dx) + absolute(dy) + absolute(dz)) * u + d_sum * T(row_error);
  };
  axis(map.row_x, map.row_error.x, map.origin_error.x, line.origin.x, line.direction.x, line.origin_error.x,
       line.direction_error.x);
  axis(map.row_y, map.row_error.y, map.origin_error.y, line.origin.y, line.direction.y, line.origin_error.y,
       line.direction_error.y);
  axis(map.row_z, map.row_error.z, map.origin_error.z, line.origin.z, line.direction.z, line.origin_error.z,
       line.direction_error.z);
  return line;
}

/// The image of a line that has errors of its own.
template <class T, class N>
[[nodiscard]] ObjectLine<T> object_line(const LineMap<N>& map, const ObjectLine<T>& outer) {
  ObjectLine<T> line = object_line(map, outer.origin, outer.direction);
  const auto spread = [&](const Vec3<N>& row, const N& row_error, const Vec3<T>& e) {
    return T(absolute(row.x) + row_error) * e.x + T(absolute(row.y) + row_error) * e.y +
           T(absolute(row.z) + row_error) * e.z;
  };
  const Vec3<T>&oe = outer.origin_error, &de = outer.direction_error;
  const auto add = [&](const Vec3<N>& row, const N& row_error, T& p, T& d) {
    p = p + spread(row, row_error, oe) * 1.01;
    d = d + spread(row, row_error, de) * 1.01;
  };
  add(map.row_x, map.row_error.x, line.origin_error.x, line.direction_error.x);
  add(map.row_y, map.row_error.y, line.origin_error.y, line.direction_error.y);
  add(map.row_z, map.row_error.z, line.origin_error.z, line.direction_error.z);
  return line;
}

/// Exactly, through one map after the other, the outermost first.
[[nodiscard]] ExactLine exact_line(std::span<const Affine3d> chain, const ExactLine& line);
[[nodiscard]] ExactLine exact_line(const Rayf& ray_world);

/// A point, without error bounds.
[[nodiscard]] inline Vec3d map_point(const LineMap<double>& map, const Vec3d& p) {
  const Vec3d v = p - map.center;
  return {dot(map.row_x, v), dot(map.row_y, v), dot(map.row_z, v)};
}

/// A normal of the inner space to the outer: by the inverse transpose, not normalised.
[[nodiscard]] inline Vec3d outer_normal(const LineMap<double>& map, const Vec3d& n) {
  return map.row_x * n.x + map.row_y * n.y + map.row_z * n.z;
}

}  // namespace alhazen
