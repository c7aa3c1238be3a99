// A general quadric from its ten coefficients: open in a box, or solid with flat caps where the box cuts it.
#pragma once

#include <array>
#include <optional>

#include "accel/shapes/quadric_body.h"
#include "core/ray.h"

namespace alhazen {

/// f(p) = A x² + B y² + C z² + 2D xy + 2E xz + 2F yz + 2G x + 2H y + 2I z + J, inside where f < 0.
struct Quadric {
  std::array<double, 10> coefficients{1, 1, 1, 0, 0, 0, 0, 0, 0, -1};  // A ... J
  Bounds3d box{{-1, -1, -1}, {1, 1, 1}};  // finite; a whole ellipsoid lies within it and is not cut
  bool solid = false;                     // { f <= 0 } within the box is a closed body
  bool whole = false;                     // an ellipsoid that the box does not cut: said so, it costs less
};

/// The box of an ellipsoid's surface, a little enlarged (its centre alone where nothing of it is real); none where
/// A ... F is not definite.
[[nodiscard]] std::optional<Bounds3d> ellipsoid_bounds(const std::array<double, 10>& coefficients);

template <class N>
[[nodiscard]] QuadricBody<N> quadric_body(const Quadric& quadric) {
  const auto& q = quadric.coefficients;
  QuadricBody<N> body{N(q[0]), N(q[1]), N(q[2]), N(q[3]), N(q[4]), N(q[5]),      N(q[6]),
                      N(q[7]), N(q[8]), N(q[9]), {},      {},      quadric.solid};
  body.lower = Vec3<N>(quadric.box.lower), body.upper = Vec3<N>(quadric.box.upper);
  return body;
}

/// Solid, where a line enters and leaves the body; open, where it meets the surface within the closed box.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Quadric& quadric, const ObjectLine<T>& line) {
  const auto body = quadric_body<CoefficientOf<T>>(quadric);
  return quadric.whole ? body_crossings<BodyForm::whole>(body, line) : body_crossings<BodyForm::general>(body, line);
}
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Quadric& quadric, const ExactLine& line);

/// Tight up to 1 % of the box where the surface leaves parts of it empty; empty where nothing can be hit.
[[nodiscard]] Bounds3d bounds(const Quadric& quadric) noexcept;

/// No point of the shape is further from `p_object`, by the form's eigenvalues alone: infinite where they do not bound
/// it.
[[nodiscard]] double reach_from(const Quadric& quadric, const Vec3d& p_object) noexcept;

[[nodiscard]] Vec3d project(const Quadric& quadric, const Vec3d& p_object, int face) noexcept;

/// ∇f / |∇f|, towards f > 0; on a cap, the box face's. On a double plane, that plane's; zero at other singular points.
[[nodiscard]] Vec3d normal(const Quadric& quadric, const Vec3d& p_object, int face) noexcept;

/// u = (x - min.x) / (max.x - min.x), v = (z - min.z) / (max.z - min.z), of the box.
[[nodiscard]] Vec2f texture_coordinates(const Quadric& quadric, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d u_tangent(const Quadric& quadric, const Vec3d& p_object, int face) noexcept;

}  // namespace alhazen
