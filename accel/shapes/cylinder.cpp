#include "accel/shapes/cylinder.h"

#include <cmath>
#include <numbers>

namespace alhazen {
namespace {

constexpr int kBottom = 2;

CylinderWall<double> wall_of(const Cylinder& c) { return {c.height, c.radius_bottom, c.radius_top}; }

}  // namespace

std::vector<ExactCrossing> exact_crossings(const Cylinder& cylinder, const ExactLine& line) {
  return exact_crossings(quadric_body<Rational>(cylinder), BodyParts{}, line);
}

Bounds3d bounds(const Cylinder& cylinder) noexcept {
  const double r = std::max(cylinder.radius_bottom, cylinder.radius_top), h = cylinder.height / 2;
  return {{-r, -h, -r}, {r, h, r}};
}

std::optional<FlatFace<double>> flat_face(const Cylinder& cylinder, int face) noexcept {
  if (face == kWallFace) return {};
  return flat_face(face, (face == kBottom ? -0.5 : 0.5) * cylinder.height);
}

Vec3d project(const Cylinder& cylinder, const Vec3d& p_object, int face) noexcept {
  const auto cap = flat_face(cylinder, face);
  return cap ? project(*cap, p_object) : project(wall_of(cylinder), p_object);
}

Vec3d normal(const Cylinder& cylinder, const Vec3d& p_object, int face) noexcept {
  const auto cap = flat_face(cylinder, face);
  return cap ? normal(*cap) : normal(wall_of(cylinder), p_object);
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
