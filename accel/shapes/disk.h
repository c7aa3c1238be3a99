// A flat ring in the plane y = 0 about the origin, normal +y.
#pragma once

#include "accel/shapes/flat_face.h"
#include "accel/shapes/quadric_body.h"
#include "core/ray.h"

namespace alhazen {

struct Disk {
  double radius = 1, inner_radius = 0;  // inner_radius² <= x² + z² <= radius²
};

/// Where a line crosses the disk: at most once. A line in its plane misses.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Disk& disk, const ObjectLine<T>& line) {
  const double u = kUnitRoundoff<T>;
  LineCrossings<T> out;
  const Vec3<T>&d = line.direction, de = line.direction_error;
  // A line that stays off the plane as long as it is near the disk misses, however flat it runs.
  const T t0 = -(dot(line.origin, d) / dot(d, d));
  const ObjectLine<T> local = moved_origin(line, t0);
  const Vec3<T>&p = local.origin, pe = local.origin_error;
  const T reach = T(disk.radius * 2) / larger(absolute(d.x), larger(absolute(d.y), absolute(d.z)));
  const auto off = absolute(p.y) - pe.y > (absolute(d.y) + de.y) * reach;
  const auto steep = absolute(d.y) > de.y * 4;
  const T inverse = T(1) / select(steep, d.y, T(1));
  const T s = -(p.y * inverse);
  const T s_error = (pe.y + absolute(s) * de.y) * absolute(inverse) * 2 + absolute(s) * (4 * u);
  const auto coordinate = [&](const T& o, const T& oe, const T& dir, const T& dir_error, T& error) {
    error = oe + absolute(s) * dir_error + (absolute(dir) + dir_error) * s_error +
            (absolute(o) + absolute(s * dir)) * (3 * u);
    return o + s * dir;
  };
  T x_error, z_error;
  const T x = coordinate(p.x, pe.x, d.x, de.x, x_error), z = coordinate(p.z, pe.z, d.z, de.z, z_error);
  const T squared = x * x + z * z;
  const T error = (absolute(x) * x_error + absolute(z) * z_error) * 2.5 + x_error * x_error + z_error * z_error +
                  squared * (4 * u) + T(disk.radius * disk.radius * 4 * u);
  const T outer_gap = T(disk.radius) * T(disk.radius) - squared;
  const T inner_gap = squared - T(disk.inner_radius) * T(disk.inner_radius);
  const auto full = T(disk.inner_radius) == T(0);
  const auto inside = (outer_gap > error) && (full || inner_gap > error);
  const auto outside = (outer_gap < -error) || (!full && inner_gap < -error);
  out.at[0] = {t0 + s, s_error + (absolute(t0) + absolute(s)) * (2 * u), T(3), steep && inside && !off};
  out.doubtful = !off && (!steep || (!inside && !outside));
  return out;
}
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Disk& disk, const ExactLine& line);

[[nodiscard]] Bounds3d bounds(const Disk& disk) noexcept;
[[nodiscard]] std::optional<FlatFace<double>> flat_face(const Disk& disk, int face) noexcept;
[[nodiscard]] Vec3d project(const Disk& disk, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d normal(const Disk& disk, const Vec3d& p_object, int face) noexcept;

/// u = 0.5 + x / 2R, v = 0.5 + z / 2R.
[[nodiscard]] Vec2f texture_coordinates(const Disk& disk, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d u_tangent(const Disk& disk, const Vec3d& p_object, int face) noexcept;

}  // namespace alhazen
