#include "accel/shapes/sphere.h"

#include <cmath>
#include <numbers>

namespace alhazen {

std::vector<ExactCrossing> exact_crossings(const Sphere& sphere, const ExactLine& line) {
  return exact_crossings(quadric_body<Rational>(sphere), BodyParts{.planes = false, .wall = true}, line);
}

Bounds3d bounds(const Sphere& sphere) noexcept {
  const double r = sphere.radius;
  return {{-r, -r, -r}, {r, r, r}};
}

Vec3d project(const Sphere& sphere, const Vec3d& p_object, int) noexcept { return normalize(p_object) * sphere.radius; }

Vec3d normal(const Sphere&, const Vec3d& p_object, int) noexcept { return normalize(p_object); }

Vec2f texture_coordinates(const Sphere&, const Vec3d& p_object, int) noexcept {
  const Vec3d n = normalize(p_object);
  return {float(0.5 + std::atan2(n.x, n.z) / (2 * std::numbers::pi)),
          float(std::acos(std::clamp(n.y, -1.0, 1.0)) / std::numbers::pi)};
}

Vec3d u_tangent(const Sphere&, const Vec3d& p_object, int) noexcept { return {p_object.z, 0, -p_object.x}; }

}  // namespace alhazen
