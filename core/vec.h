// Small fixed-size vectors and linear colours.
//
// Plain data and free functions; every operation is component-wise unless its name says otherwise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace alhazen {

template <class T>
struct Vec2 {
  T x = 0, y = 0;
  friend bool operator==(Vec2, Vec2) = default;
};

template <class T>
struct Vec3 {
  T x = 0, y = 0, z = 0;

  constexpr Vec3() = default;
  constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  /// Rounds (double to float) or widens each component.
  template <class U>
  constexpr explicit Vec3(const Vec3<U>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}

  [[nodiscard]] constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

template <class T>
struct Vec4 {
  T x = 0, y = 0, z = 0, w = 0;
  friend bool operator==(const Vec4&, const Vec4&) = default;
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Vec4f = Vec4<float>;

template <class T>
constexpr Vec2<T> operator+(Vec2<T> a, Vec2<T> b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
constexpr Vec2<T> operator-(Vec2<T> a, Vec2<T> b) {
  return {a.x - b.x, a.y - b.y};
}
template <class T>
constexpr Vec2<T> operator*(Vec2<T> a, T s) {
  return {a.x * s, a.y * s};
}
template <class T>
constexpr Vec2<T> operator*(T s, Vec2<T> a) {
  return a * s;
}

template <class T>
constexpr Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
constexpr Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Vec3<T> operator*(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
constexpr Vec3<T> operator*(const Vec3<T>& a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
constexpr Vec3<T> operator*(T s, const Vec3<T>& a) {
  return a * s;
}
template <class T>
constexpr Vec3<T> operator/(const Vec3<T>& a, T s) {
  return {a.x / s, a.y / s, a.z / s};
}
template <class T>
constexpr Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
constexpr Vec3<T>& operator+=(Vec3<T>& a, const Vec3<T>& b) {
  return a = a + b;
}

template <class T>
[[nodiscard]] constexpr T dot(Vec2<T> a, Vec2<T> b) {
  return a.x * b.x + a.y * b.y;
}
template <class T>
[[nodiscard]] constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
[[nodiscard]] constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
[[nodiscard]] T length(const Vec3<T>& a) {
  return std::sqrt(dot(a, a));
}
template <class T>
[[nodiscard]] Vec3<T> abs(const Vec3<T>& a) {
  return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class T>
[[nodiscard]] constexpr T max_component(const Vec3<T>& a) {
  return std::max(a.x, std::max(a.y, a.z));
}
template <class T>
[[nodiscard]] bool is_finite(const Vec3<T>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// `a` over its length. The zero vector (and one whose squared length underflows) has no direction: it comes back as it
/// is.
template <class T>
[[nodiscard]] Vec3<T> normalize(const Vec3<T>& a) {
  const T squared = dot(a, a);
  return squared > 0 ? a / std::sqrt(squared) : a;
}

/// `d` mirrored about the plane with unit normal `n`.
template <class T>
[[nodiscard]] constexpr Vec3<T> reflect(const Vec3<T>& d, const Vec3<T>& n) {
  return d - (T(2) * dot(d, n)) * n;
}

/// A linear colour or a weight for each of red, green and blue (no encoding, no unit); of lanes: one for each lane.
template <class F>
struct BasicRgb {
  F r = 0, g = 0, b = 0;

  constexpr BasicRgb() = default;
  constexpr explicit BasicRgb(F grey) : r(grey), g(grey), b(grey) {}
  constexpr BasicRgb(F r_, F g_, F b_) : r(r_), g(g_), b(b_) {}
  /// The same in every lane.
  template <class G>
  constexpr explicit BasicRgb(const BasicRgb<G>& c) : r(c.r), g(c.g), b(c.b) {}
  friend bool operator==(const BasicRgb&, const BasicRgb&) = default;
};

using Rgb = BasicRgb<float>;

template <class F>
constexpr BasicRgb<F> operator+(const BasicRgb<F>& a, const BasicRgb<F>& b) {
  return {a.r + b.r, a.g + b.g, a.b + b.b};
}
template <class F>
constexpr BasicRgb<F> operator-(const BasicRgb<F>& a, const BasicRgb<F>& b) {
  return {a.r - b.r, a.g - b.g, a.b - b.b};
}
template <class F>
constexpr BasicRgb<F> operator*(const BasicRgb<F>& a, const BasicRgb<F>& b) {
  return {a.r * b.r, a.g * b.g, a.b * b.b};
}
template <class F>
constexpr BasicRgb<F> operator*(const BasicRgb<F>& a, std::type_identity_t<F> s) {
  return {a.r * s, a.g * s, a.b * s};
}
template <class F>
constexpr BasicRgb<F> operator*(std::type_identity_t<F> s, const BasicRgb<F>& a) {
  return a * s;
}
template <class F>
constexpr BasicRgb<F>& operator+=(BasicRgb<F>& a, const BasicRgb<F>& b) {
  return a = a + b;
}
template <class F>
constexpr BasicRgb<F>& operator*=(BasicRgb<F>& a, const BasicRgb<F>& b) {
  return a = a * b;
}
[[nodiscard]] constexpr float max_component(const Rgb& a) { return std::max(a.r, std::max(a.g, a.b)); }
[[nodiscard]] inline bool is_finite(const Rgb& a) {
  return std::isfinite(a.r) && std::isfinite(a.g) && std::isfinite(a.b);
}
template <class F>
[[nodiscard]] constexpr BasicRgb<F> lerp(const BasicRgb<F>& a, const BasicRgb<F>& b, std::type_identity_t<F> t) {
  return a * (1 - t) + b * t;
}

/// A linear colour with straight (not premultiplied) alpha.
template <class F>
struct BasicRgba {
  BasicRgb<F> rgb{F(1.0f)};
  F a = 1;
};

using Rgba = BasicRgba<float>;

/// "No such element" for the 32-bit indices that scene elements use in place of pointers.
inline constexpr uint32_t kNone = 0xFFFFFFFFu;

}  // namespace alhazen
