#include "accel/shapes/cylinder.h"

#include <cmath>
#include <numbers>

namespace alhazen {
namespace {

constexpr int kBottom = 2;

/// Exactly 0 at an apex.
double radius_at(const Cylinder& c, double y) {
  return c.radius_top + (c.radius_bottom - c.radius_top) * ((c.height / 2 - y) / c.height);
}

}  // namespace

std::vector<ExactCrossing> exact_crossings(const Cylinder& cylinder, const ExactLine& line) {
  return exact_crossings(quadric_body<Rational>(cylinder), BodyParts{}, line);
}

Bounds3d bounds(const Cylinder& cylinder) noexcept {
  const double r = std::max(cylinder.radius_bottom, cylinder.radius_top), h = cylinder.height / 2;
  return {{-r, -h, -r}, {r, h, r}};
}

Vec3d project(const Cylinder& cylinder, const Vec3d& p, int face) noexcept {
  const double h = cylinder.height / 2;
  if (face != kWallFace) return {p.x, face == kBottom ? -h : h, p.z};
  const double distance = std::hypot(p.x, p.z), y = std::clamp(p.y, -h, h), radius = radius_at(cylinder, y);
  // A hit beside an apex may round onto the axis; any point of the wall is as near then.
  if (!(distance > 0)) return {radius, y, 0};
  return {p.x * (radius / distance), y, p.z * (radius / distance)};
}

Vec3d normal(const Cylinder& cylinder, const Vec3d& p, int face) noexcept {
  if (face != kWallFace) return {0, face == kBottom ? -1.0 : 1.0, 0};
  const double distance = std::hypot(p.x, p.z);
  const double slope = (cylinder.radius_top - cylinder.radius_bottom) / cylinder.height;
  if (!(distance > 0)) return {0, slope < 0 ? 1.0 : -1.0, 0};
  return normalize(Vec3d{p.x / distance, -slope, p.z / distance});
}

Vec2f texture_coordinates(const Cylinder& cylinder, const Vec3d& p, int face) noexcept {
  if (face == kWallFace)
    return {float(0.5 + std::atan2(p.x, p.z) / (2 * std::numbers::pi)), float(0.5 - p.y / cylinder.height)};
  const double diameter = 2 * (face == kBottom ? cylinder.radius_bottom : cylinder.radius_top);
  return {float(0.5 + p.x / diameter), float(0.5 + p.z / diameter)};
}

Vec3d u_tangent(const Cylinder&, const Vec3d& p, int face) noexcept {
  return face == kWallFace ? Vec3d{p.z, 0, -p.x} : Vec3d{1, 0, 0};
}

}  // namespace alhazen
