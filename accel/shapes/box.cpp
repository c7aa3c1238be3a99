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

std::optional<FlatFace<double>> flat_face(const Box& box, int face) noexcept {
  return flat_face(face, (face & 1 ? 0.5 : -0.5) * box.size[face / 2]);
}

Vec3d project(const Box& box, const Vec3d& p_object, int face) noexcept {
  return project(*flat_face(box, face), p_object);
}

Vec3d normal(const Box& box, const Vec3d&, int face) noexcept { return normal(*flat_face(box, face)); }

Vec2f texture_coordinates(const Box& box, const Vec3d& p_object, int face) noexcept {
  const FaceFrame frame = face_frame(face);
  const Vec3d unit{p_object.x / box.size.x, p_object.y / box.size.y, p_object.z / box.size.z};
  return {float(0.5 + dot(unit, frame.right)), float(0.5 + dot(unit, frame.down))};
}

Vec3d u_tangent(const Box&, const Vec3d&, int face) noexcept { return face_frame(face).right; }

}  // namespace alhazen
