// The whole sphere of directions as an image twice as wide as high: y up, the middle of a row looks along -z, +x lies
// in the right half.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"

namespace alhazen {

/// The unit direction at the middle of a pixel.
[[nodiscard]] inline Vec3f equirectangular_direction(int x, int y, int width, int height) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float phi = (2 * (float(x) + 0.5f) / float(width) - 1) * kPi, theta = (float(y) + 0.5f) / float(height) * kPi;
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

/// Where a unit direction lies in the image, from 0 to 1 each way.
template <class F>
[[nodiscard]] Vec2<F> equirectangular_place(const Vec3<F>& d) {
  constexpr float kPi = std::numbers::pi_v<float>;
  return {F(0.5f) + arc_tangent(d.x, F(-d.z)) / F(2 * kPi), arc_cosine(clamped(d.y, -1, 1)) / F(kPi)};
}

}  // namespace alhazen
