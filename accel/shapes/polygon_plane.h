// The plane coordinates of a polygon, and its index of edges: what making one and crossing one share.
#pragma once

#include <algorithm>

#include "accel/shapes/polygon.h"

namespace alhazen {

/// `v` in the cyclic order that puts `last_axis` last, and back.
template <class T>
Vec3<T> to_plane_axes(const Vec3<T>& v, int last_axis) {
  return last_axis == 0 ? Vec3<T>{v.y, v.z, v.x} : last_axis == 1 ? Vec3<T>{v.z, v.x, v.y} : v;
}
template <class T>
Vec3<T> from_plane_axes(const Vec3<T>& v, int last_axis) {
  return last_axis == 0 ? Vec3<T>{v.z, v.x, v.y} : last_axis == 1 ? Vec3<T>{v.y, v.z, v.x} : v;
}

/// The point of the plane above `vertex`, less the center.
inline Vec3d lifted(const Polygon& polygon, const Vec3d& vertex) {
  const Vec3d p = to_plane_axes(vertex - polygon.center, polygon.dropped_axis);
  const double z = polygon.plane.offset + polygon.plane.slope_x * p.x + polygon.plane.slope_y * p.y;
  return from_plane_axes(Vec3d{p.x, p.y, z}, polygon.dropped_axis);
}

/// The point of the plane nearest to a point, and its texture coordinates; of one point or those of lanes.
template <class N>
Vec3<N> nearest_in_plane(const Polygon& polygon, const Vec3<N>& p_object) {
  const auto in_all = [](const Vec3d& v) { return Vec3<N>{N(v.x), N(v.y), N(v.z)}; };
  const Vec3<N> p = to_plane_axes(p_object - in_all(polygon.center), polygon.dropped_axis);
  const HeightPlane<double>& plane = polygon.plane;
  const N rise = p.z - N(plane.slope_x) * p.x - N(plane.slope_y) * p.y - N(plane.offset);
  return p_object - in_all(polygon.unit_normal) * N(rise * N(polygon.unit_normal[polygon.dropped_axis]));
}
template <class N>
Vec2<N> uv_in_plane(const Polygon& polygon, const Vec3<N>& p_object) {
  const auto in_all = [](const Vec3d& v) { return Vec3<N>{N(v.x), N(v.y), N(v.z)}; };
  const Vec3<N> p = p_object - in_all(polygon.center);
  return {N(polygon.uv_origin.x) + dot(p, in_all(polygon.u_direction)),
          N(polygon.uv_origin.y) + dot(p, in_all(polygon.v_direction))};
}

/// The strip of height y; the nearest for y outside of all.
inline size_t strip_of(const Polygon& polygon, double y) {
  const double strip = (y - polygon.strips_lower) * polygon.strips_per_y;
  const size_t last = polygon.strips.size() - 2;
  return strip > 0 ? std::min(last, size_t(std::min(strip, double(last)))) : 0;
}

}  // namespace alhazen
