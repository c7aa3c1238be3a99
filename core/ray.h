// Rays and axis-aligned boxes.
#pragma once

#include <limits>

#include "core/vec.h"

namespace alhazen {

/// The points origin + t direction for t in [t_min, t_max]. The direction need not have unit length; t counts in its
/// lengths.
template <class T>
struct Ray {
  Vec3<T> origin, direction;
  T t_min = 0, t_max = std::numeric_limits<T>::infinity();
};

using Rayf = Ray<float>;
using Rayd = Ray<double>;

template <class T>
[[nodiscard]] constexpr Vec3<T> point_at(const Ray<T>& ray, T t) {
  return ray.origin + ray.direction * t;
}

/// The closed box between two corners; empty (lower > upper) at first.
template <class T>
struct Bounds3 {
  Vec3<T> lower{std::numeric_limits<T>::infinity(), std::numeric_limits<T>::infinity(),
                std::numeric_limits<T>::infinity()};
  Vec3<T> upper{-std::numeric_limits<T>::infinity(), -std::numeric_limits<T>::infinity(),
                -std::numeric_limits<T>::infinity()};
};

using Bounds3f = Bounds3<float>;
using Bounds3d = Bounds3<double>;

template <class T>
[[nodiscard]] constexpr bool is_empty(const Bounds3<T>& b) {
  return !(b.lower.x <= b.upper.x && b.lower.y <= b.upper.y && b.lower.z <= b.upper.z);
}
template <class T>
constexpr void extend(Bounds3<T>& b, const Vec3<T>& p) {
  b.lower = min(b.lower, p), b.upper = max(b.upper, p);
}
template <class T>
constexpr void extend(Bounds3<T>& b, const Bounds3<T>& c) {
  b.lower = min(b.lower, c.lower), b.upper = max(b.upper, c.upper);
}

}  // namespace alhazen
