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
///
/// accuracy  the error bounds hold; doubtful where hit or miss is not certain.
/// source    from the point nearest to the centre: Haines, Günther, Akenine-Möller, Ray Tracing Gems (2019), ch. 7.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Sphere& sphere, const ObjectLine<T>& line) {
  const double u = kUnitRoundoff<T>;
  const Vec3<T>&o = line.origin, &d = line.direction;
  const auto largest = [](const Vec3<T>& v) { return larger(absolute(v.x), larger(absolute(v.y), absolute(v.z))); };
  const T o_size = largest(o), d_size = largest(d), oe = largest(line.origin_error), de = largest(line.direction_error);
  const T inverse = T(1) / dot(d, d), t0 = -(dot(o, d) * inverse), t0_size = absolute(t0);
  const Vec3<T> p = o + d * t0;
  const T p_error = oe + o_size * (1.1 * u) + t0_size * (de + d_size * (2.1 * u));
  const T radius(sphere.radius), squared = radius * radius, gap = squared - dot(p, p);
  const T gap_error = (largest(p) * 7 + p_error * 3) * p_error + squared * (8 * u);
  // How far t0 may be from the middle of the chord, and half of the chord.
  const T middle_error = (o_size * (de * 9 + d_size * (21 * u)) + d_size * oe * 3) * inverse;
  LineCrossings<T> out;
  const auto hit = gap > gap_error * 2;
  const T half = square_root(select(hit, gap, T(0)) * inverse);
  const T error = middle_error + half * (gap_error / gap + d_size * de * inverse * 3) + (t0_size + half) * (4 * u);
  out.at[0] = {t0 - half, error, T(kWallFace), hit};
  out.at[1] = {t0 + half, error, T(kWallFace), hit};
  out.doubtful = !hit && !(gap < -gap_error);
  return out;
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
