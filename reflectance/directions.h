// Directions by their angles, in the surface's frame.
#pragma once

#include <numbers>

#include "core/vec.h"

namespace alhazen {

inline constexpr double kDegree = std::numbers::pi / 180;  // radians

/// From the normal by `theta`, from the tangent towards the bitangent by `phi`, in degrees. Unit length.
[[nodiscard]] Vec3f direction_at(double theta, double phi) noexcept;

/// The angle to the normal, in degrees.
[[nodiscard]] double theta_of(const Vec3f& direction) noexcept;

/// `direction` mirrored about the normal.
[[nodiscard]] inline Vec3f mirrored(const Vec3f& direction) noexcept {
  return {-direction.x, -direction.y, direction.z};
}

/// The equal-area map of the hemisphere to the unit disk (Lambert's azimuthal projection), whose centre is the normal:
/// the direction at a point of the disk.
[[nodiscard]] Vec3f direction_of_disk(const Vec2d& p) noexcept;
[[nodiscard]] Vec2d disk_of_direction(const Vec3f& direction) noexcept;

}  // namespace alhazen
