#include "accel/shapes/disk.h"

namespace alhazen {

std::vector<ExactCrossing> exact_crossings(const Disk& disk, const ExactLine& line) {
  const auto &p = line.origin, &d = line.direction;
  if (sgn(d.y) == 0) return {};
  const Rational t = -p.y / d.y, x = p.x + t * d.x, z = p.z + t * d.z, squared = x * x + z * z;
  const Rational outer = exact(disk.radius), inner = exact(disk.inner_radius);
  if (squared > outer * outer || squared < inner * inner) return {};
  return {{Surd(t), 3}};
}

Bounds3d bounds(const Disk& disk) noexcept { return {{-disk.radius, 0, -disk.radius}, {disk.radius, 0, disk.radius}}; }

std::optional<FlatFace<double>> flat_face(const Disk&, int) noexcept { return flat_face(3, 0.0); }

Vec3d project(const Disk& disk, const Vec3d& p_object, int face) noexcept {
  return project(*flat_face(disk, face), p_object);
}

Vec3d normal(const Disk& disk, const Vec3d&, int face) noexcept { return normal(*flat_face(disk, face)); }

Vec2f texture_coordinates(const Disk& disk, const Vec3d& p_object, int) noexcept {
  return {float(0.5 + p_object.x / (2 * disk.radius)), float(0.5 + p_object.z / (2 * disk.radius))};
}

Vec3d u_tangent(const Disk&, const Vec3d&, int) noexcept { return {1, 0, 0}; }

}  // namespace alhazen
