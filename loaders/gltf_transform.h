// The maps that glTF writes as rotation and scale.
#pragma once

#include <array>

#include "core/transform.h"

namespace alhazen {

/// The rotation of the quaternion (x, y, z, w), of any length but 0, after the scale.
[[nodiscard]] constexpr Affine3d rotate_scale(const std::array<double, 4>& q, const Vec3d& scale) {
  const double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], s = 2 / norm;
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {Vec3d{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)} * scale.x,
          Vec3d{s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)} * scale.y,
          Vec3d{s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)} * scale.z,
          {0, 0, 0}};
}

}  // namespace alhazen
