// The sphere x² + y² + z² = radius² about the origin of its own space.
#pragma once

#include "accel/shapes/quadric_body.h"
#include "core/ray.h"

namespace alhazen {

struct Sphere {
  double radius = 1;
};

template <class N>
[[nodiscard]] QuadricBody<N> quadric_body(const Sphere& sphere) {
  QuadricBody<N> body;
  body.a = body.b = body.c = N(1);
  body.j = -(N(sphere.radius) * N(sphere.radius));
  return body;
}

/// Where a line enters and leaves the ball. A tangent line, decided exactly, touches it once: both at one parameter.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Sphere& sphere, const ObjectLine<T>& line) {
  return body_crossings<BodyForm::sphere>(quadric_body<CoefficientOf<T>>(sphere), line);
}
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Sphere& sphere, const ExactLine& line);

[[nodiscard]] Bounds3d bounds(const Sphere& sphere) noexcept;

/// The point of the surface nearest to `p_object`, a point within rounding of it.
[[nodiscard]] Vec3d project(const Sphere& sphere, const Vec3d& p_object, int face) noexcept;

/// The outward unit normal at a point of the surface.
[[nodiscard]] Vec3d normal(const Sphere& sphere, const Vec3d& p_object, int face) noexcept;

/// u = 0.5 + atan2(x, z) / 2π, v = acos(y / r) / π.
[[nodiscard]] Vec2f texture_coordinates(const Sphere& sphere, const Vec3d& p_object, int face) noexcept;

/// ∂p/∂u at a point of the surface, not normalised: the direction in which the texture's u grows. Zero at the poles.
[[nodiscard]] Vec3d u_tangent(const Sphere& sphere, const Vec3d& p_object, int face) noexcept;

}  // namespace alhazen
