// Affine maps. A map is named after both of its spaces, `world_from_object`, so that products read like units that
// cancel.
#pragma once

#include <array>

#include "core/ray.h"
#include "core/vec.h"

namespace alhazen {

/// p -> x p.x + y p.y + z p.z + origin: `x`, `y`, `z` are the images of the axes (the columns), `origin` that of the
/// origin.
template <class T>
struct Affine3 {
  Vec3<T> x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};

  constexpr Affine3() = default;
  constexpr Affine3(const Vec3<T>& x_, const Vec3<T>& y_, const Vec3<T>& z_, const Vec3<T>& o)
      : x(x_), y(y_), z(z_), origin(o) {}
  template <class U>
  constexpr explicit Affine3(const Affine3<U>& m) : x(m.x), y(m.y), z(m.z), origin(m.origin) {}
  friend bool operator==(const Affine3&, const Affine3&) = default;
};

using Affine3f = Affine3<float>;
using Affine3d = Affine3<double>;

template <class T>
[[nodiscard]] constexpr Vec3<T> transform_vector(const Affine3<T>& m, const Vec3<T>& v) {
  return m.x * v.x + m.y * v.y + m.z * v.z;
}
template <class T>
[[nodiscard]] constexpr Vec3<T> transform_point(const Affine3<T>& m, const Vec3<T>& p) {
  return transform_vector(m, p) + m.origin;
}

template <class T>
[[nodiscard]] constexpr T determinant(const Affine3<T>& m) {
  return dot(m.x, cross(m.y, m.z));
}

/// (M^-1)^T n times |det M|: right in direction and side for any invertible M, mirrors included, and finite even where
/// the inverse would overflow. Not normalised.
template <class T>
[[nodiscard]] constexpr Vec3<T> transform_normal(const Affine3<T>& m, const Vec3<T>& n) {
  const Vec3<T> v = cross(m.y, m.z) * n.x + cross(m.z, m.x) * n.y + cross(m.x, m.y) * n.z;
  return determinant(m) < 0 ? -v : v;
}

/// First `b`, then `a`.
template <class T>
[[nodiscard]] constexpr Affine3<T> operator*(const Affine3<T>& a, const Affine3<T>& b) {
  return {transform_vector(a, b.x), transform_vector(a, b.y), transform_vector(a, b.z), transform_point(a, b.origin)};
}

/// The inverse by cofactors; not finite where `m` is not invertible (the caller asks `is_invertible`).
template <class T>
[[nodiscard]] constexpr Affine3<T> inverse(const Affine3<T>& m) {
  const Vec3<T> r0 = cross(m.y, m.z), r1 = cross(m.z, m.x), r2 = cross(m.x, m.y);
  const T s = 1 / dot(m.x, r0);
  const Affine3<T> linear{
      Vec3<T>{r0.x, r1.x, r2.x} * s, Vec3<T>{r0.y, r1.y, r2.y} * s, Vec3<T>{r0.z, r1.z, r2.z} * s, {0, 0, 0}};
  return {linear.x, linear.y, linear.z, -transform_vector(linear, m.origin)};
}

/// The rotation of the quaternion (x, y, z, w), of any length but 0, after the scale.
[[nodiscard]] constexpr Affine3d rotate_scale(const std::array<double, 4>& q, const Vec3d& scale) {
  const double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], s = 2 / norm;
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {Vec3d{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)} * scale.x,
          Vec3d{s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)} * scale.y,
          Vec3d{s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)} * scale.z,
          {0, 0, 0}};
}

template <class T>
[[nodiscard]] bool is_finite(const Affine3<T>& m) {
  return is_finite(m.x) && is_finite(m.y) && is_finite(m.z) && is_finite(m.origin);
}
template <class T>
[[nodiscard]] bool is_invertible(const Affine3<T>& m) {
  return is_finite(m) && determinant(m) != 0 && is_finite(inverse(m));
}

/// The smallest box around the image of `bounds`, in exact arithmetic; empty stays empty.
template <class T>
[[nodiscard]] Bounds3<T> transform_bounds(const Affine3<T>& m, const Bounds3<T>& bounds) {
  if (is_empty(bounds)) return bounds;
  const Vec3<T> center = (bounds.lower + bounds.upper) * T(0.5), half = bounds.upper - center;
  const Vec3<T> c = transform_point(m, center), h = abs(m.x) * half.x + abs(m.y) * half.y + abs(m.z) * half.z;
  return {c - h, c + h};
}

}  // namespace alhazen
