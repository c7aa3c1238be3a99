#include "accel/shapes/sphere.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace alhazen {

Crossings crossings(const Sphere& sphere, const Rayd& ray_object) noexcept {
  const double r = sphere.radius;
  const Vec3d& d = ray_object.direction;
  const double dd = dot(d, d);
  // Measure from the point of closest approach: the discriminant then loses nothing when the origin is far away.
  const double t_closest = -dot(ray_object.origin, d) / dd;
  const Vec3d p_closest = ray_object.origin + d * t_closest;
  const double distance = length(p_closest);
  const double discriminant = (r - distance) * (r + distance);
  if (!(discriminant > 0) || !(dd > 0)) return {};  // written so that NaN is a miss
  const double half = std::sqrt(discriminant / dd);
  // Take the root that adds numbers of one sign; the other follows from t0 t1 = (o·o - r²) / (d·d).
  const double far = t_closest + std::copysign(half, t_closest);
  const double o = length(ray_object.origin);
  const double near = (o - r) * (o + r) / (dd * far);
  return {{std::min(near, far), std::max(near, far)}, 2};
}

Bounds3d bounds(const Sphere& sphere) noexcept {
  const double r = sphere.radius;
  return {{-r, -r, -r}, {r, r, r}};
}

Vec3d project(const Sphere& sphere, const Vec3d& p_object) noexcept {
  return normal(sphere, p_object) * double(sphere.radius);
}

Vec3d normal(const Sphere&, const Vec3d& p_object) noexcept { return normalize(p_object); }

Vec2f texture_coordinates(const Sphere&, const Vec3d& p_object) noexcept {
  const Vec3d n = normalize(p_object);
  return {float(0.5 + std::atan2(n.x, n.z) / (2 * std::numbers::pi)),
          float(std::acos(std::clamp(n.y, -1.0, 1.0)) / std::numbers::pi)};
}

Vec3d u_tangent(const Sphere&, const Vec3d& p_object) noexcept { return {p_object.z, 0, -p_object.x}; }

}  // namespace alhazen
