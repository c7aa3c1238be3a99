// Boxes for user geometries that traversal does not pass by.
#pragma once

#include <cmath>
#include <limits>

#include "core/ray.h"

namespace alhazen {

/// The box in floats, empty ones as they are, wider by what traversal gets wrong. Embree has no robust traversal for
/// user geometries: a plane of a box is taken to lie up to 2^-22 of the ray's coordinates elsewhere, so that rays from
/// afar that meet a surface where it touches its box would be lost. With this margin none is that starts within 1000
/// sizes of the box around it, or within 4 distances of the world's origin.
[[nodiscard]] inline Bounds3f traversal_bounds(const Bounds3d& box) noexcept {
  if (is_empty(box)) return {};
  const double margin =
      0x1p-12 * max_component(box.upper - box.lower) + 0x1p-20 * max_component(max(abs(box.lower), abs(box.upper)));
  const float inf = std::numeric_limits<float>::infinity();
  const auto down = [&](double x) { return std::nextafter(float(x - margin), -inf); };
  const auto up = [&](double x) { return std::nextafter(float(x + margin), inf); };
  return {{down(box.lower.x), down(box.lower.y), down(box.lower.z)},
          {up(box.upper.x), up(box.upper.y), up(box.upper.z)}};
}

}  // namespace alhazen
