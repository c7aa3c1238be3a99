#include "reflectance/directions.h"

namespace alhazen {

Vec3f direction_at(double theta, double phi) noexcept {
  const double t = theta * kDegree, p = phi * kDegree;
  return Vec3f(Vec3d(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)));
}

double theta_of(const Vec3f& direction) noexcept {
  return std::atan2(std::hypot(double(direction.x), double(direction.y)), double(direction.z)) / kDegree;
}

Vec3f direction_of_disk(const Vec2d& p) noexcept {
  // 1 - cos is the area's share, the radius squared.
  const double r2 = std::min(dot(p, p), 1.0), z = 1 - r2, across = std::sqrt(2 - r2);
  return Vec3f(normalize(Vec3d(p.x * across, p.y * across, z)));
}

Vec2d disk_of_direction(const Vec3f& direction) noexcept {
  const double scale = 1 / std::sqrt(1 + std::max(0.0, double(direction.z)));
  return {double(direction.x) * scale, double(direction.y) * scale};
}

}  // namespace alhazen
