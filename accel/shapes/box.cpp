#include "accel/shapes/box.h"

namespace alhazen {
namespace {

/// As seen from outside, by face: where texture coordinates u and v grow.
struct FaceFrame {
  Vec3d right, down;
};

FaceFrame face_frame(int face) {
  switch (face) {
    case 0:
      return {{0, 0, 1}, {0, -1, 0}};
    case 1:
      return {{0, 0, -1}, {0, -1, 0}};
    case 2:
      return {{1, 0, 0}, {0, 0, -1}};
    case 3:
      return {{1, 0, 0}, {0, 0, 1}};
    case 4:
      return {{-1, 0, 0}, {0, -1, 0}};
    default:
      return {{1, 0, 0}, {0, -1, 0}};
  }
}

}  // namespace

std::vector<ExactCrossing> exact_crossings(const Box& box, const ExactLine& line) {
  return exact_crossings(quadric_body<Rational>(box), BodyParts{.planes = true, .wall = false}, line);
}

Bounds3d bounds(const Box& box) noexcept { return {box.size * -0.5, box.size * 0.5}; }

Vec3d project(const Box& box, const Vec3d& p_object, int face) noexcept {
  const Vec3d outward = normal(box, p_object, face);
  return p_object - outward * (dot(p_object, outward) - std::abs(dot(box.size, outward)) / 2);
}

Vec3d normal(const Box&, const Vec3d&, int face) noexcept {
  const double side = face & 1 ? 1 : -1;
  return face < 2 ? Vec3d{side, 0, 0} : face < 4 ? Vec3d{0, side, 0} : Vec3d{0, 0, side};
}

Vec2f texture_coordinates(const Box& box, const Vec3d& p_object, int face) noexcept {
  const FaceFrame frame = face_frame(face);
  const Vec3d unit{p_object.x / box.size.x, p_object.y / box.size.y, p_object.z / box.size.z};
  return {float(0.5 + dot(unit, frame.right)), float(0.5 + dot(unit, frame.down))};
}

Vec3d u_tangent(const Box&, const Vec3d&, int face) noexcept { return face_frame(face).right; }

}  // namespace alhazen
