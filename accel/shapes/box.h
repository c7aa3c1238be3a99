// The axis-aligned box of the given size about the origin.
#pragma once

#include "accel/shapes/flat_face.h"
#include "accel/shapes/quadric_body.h"
#include "core/ray.h"

namespace alhazen {

struct Box {
  Vec3d size{1, 1, 1};
};

template <class N>
[[nodiscard]] QuadricBody<N> quadric_body(const Box& box) {
  QuadricBody<N> body;
  body.upper = Vec3<N>(N(box.size.x / 2), N(box.size.y / 2), N(box.size.z / 2));  // halving is exact
  body.lower = Vec3<N>(N(-body.upper.x), N(-body.upper.y), N(-body.upper.z));
  return body;
}

/// Where a line enters and leaves the closed box; through an edge, by the smaller face.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Box& box, const ObjectLine<T>& line) {
  return body_crossings<BodyForm::box>(quadric_body<CoefficientOf<T>>(box), line);
}
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Box& box, const ExactLine& line);

[[nodiscard]] Bounds3d bounds(const Box& box) noexcept;
[[nodiscard]] std::optional<FlatFace<double>> flat_face(const Box& box, int face) noexcept;
[[nodiscard]] Vec3d project(const Box& box, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d normal(const Box& box, const Vec3d& p_object, int face) noexcept;

/// Each face a unit square, upright as seen from outside: up is +y; on the +y face -z, on the -y face +z.
[[nodiscard]] Vec2f texture_coordinates(const Box& box, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d u_tangent(const Box& box, const Vec3d& p_object, int face) noexcept;

}  // namespace alhazen
