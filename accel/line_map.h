// From world space to a shape's own: lines mapped with bounds on what the mapping's rounding does to them.
#pragma once

#include <span>

#include "accel/line.h"
#include "core/ray.h"
#include "core/transform.h"

namespace alhazen {

/// p_object = rows (p_world - center), N being double or Quad. What rounding does to a mapped vector's component is at
/// most the largest component of the vector times that row's `relative_error`; a mapped point has `origin_error` more.
template <class N>
struct LineMap {
  Vec3<N> row_x, row_y, row_z, center;
  Vec3<N> relative_error;
  Vec3<N> origin_error;  // from the rounding of `center`
};

/// Ready to map lines to the space that `world_from_object` leads from. Entries are taken as exact.
[[nodiscard]] LineMap<double> line_map(const Affine3d& world_from_object);
/// The same through several maps, the outermost first.
[[nodiscard]] LineMap<double> line_map(std::span<const Affine3d> chain);
[[nodiscard]] LineMap<Quad> quad_line_map(std::span<const Affine3d> chain);

namespace line_map_detail {

template <class T>
T largest(const Vec3<T>& v) {
  return larger(absolute(v.x), larger(absolute(v.y), absolute(v.z)));
}

template <class T, class N>
Vec3<T> rows_times(const LineMap<N>& map, const Vec3<T>& v) {
  const auto row = [&](const Vec3<N>& r) { return T(r.x) * v.x + T(r.y) * v.y + T(r.z) * v.z; };
  return {row(map.row_x), row(map.row_y), row(map.row_z)};
}

template <class T, class N>
Vec3<T> widened(const Vec3<N>& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

}  // namespace line_map_detail

/// The image of a line whose origin and direction are exact.
template <class T, class N>
[[nodiscard]] ObjectLine<T> object_line(const LineMap<N>& map, const Vec3<T>& origin, const Vec3<T>& direction) {
  using namespace line_map_detail;
  const Vec3<T> o = origin - widened<T>(map.center), relative = widened<T>(map.relative_error);
  return {rows_times(map, o), rows_times(map, direction), relative * largest(o) + widened<T>(map.origin_error),
          relative * largest(direction)};
}

/// The image of a line that has errors of its own.
template <class T, class N>
[[nodiscard]] ObjectLine<T> object_line(const LineMap<N>& map, const ObjectLine<T>& outer) {
  using namespace line_map_detail;
  ObjectLine<T> line = object_line(map, outer.origin, outer.direction);
  const auto spread = [&](const Vec3<T>& e) {
    const auto row = [&](const Vec3<N>& r) {
      return (T(absolute(r.x)) * e.x + T(absolute(r.y)) * e.y + T(absolute(r.z)) * e.z) * 1.01;
    };
    return Vec3<T>{row(map.row_x), row(map.row_y), row(map.row_z)} +
           widened<T>(map.relative_error) * (largest(e) * 1.01);
  };
  line.origin_error = line.origin_error + spread(outer.origin_error);
  line.direction_error = line.direction_error + spread(outer.direction_error);
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

/// Where a ray is at t, in the inner space, without error bounds. It is moved there before it goes along the ray: a
/// small shape far from the world's origin would else be met beside its surface.
[[nodiscard]] inline Vec3d object_point(const LineMap<double>& map, const Rayf& ray, float t) {
  const Vec3d v = Vec3d(ray.origin) - map.center + Vec3d(ray.direction) * double(t);
  return {dot(map.row_x, v), dot(map.row_y, v), dot(map.row_z, v)};
}
/// The same from the map to the outer space.
[[nodiscard]] inline Vec3d object_point(const Affine3d& world_from_object, const Rayf& ray, float t) {
  return transform_vector(inverse(world_from_object),
                          Vec3d(ray.origin) - world_from_object.origin + Vec3d(ray.direction) * double(t));
}

/// A normal of the inner space to the outer: by the inverse transpose, not normalised.
[[nodiscard]] inline Vec3d outer_normal(const LineMap<double>& map, const Vec3d& n) {
  return map.row_x * n.x + map.row_y * n.y + map.row_z * n.z;
}

}  // namespace alhazen
