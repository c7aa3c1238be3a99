// Boxes around shapes, placed or not.
#pragma once

#include <array>

#include "accel/geometry.h"
#include "accel/traversal_bounds.h"

namespace alhazen {

[[nodiscard]] inline std::array<Vec3d, 8> corners(const Bounds3d& b) {
  std::array<Vec3d, 8> points;
  for (size_t k = 0; k < points.size(); ++k)
    points[k] = {k & 1 ? b.upper.x : b.lower.x, k & 2 ? b.upper.y : b.lower.y, k & 4 ? b.upper.z : b.lower.z};
  return points;
}

[[nodiscard]] inline Bounds3d object_bounds(const Shape& shape) {
  return std::visit([](const auto& s) { return bounds(s); }, shape);
}

/// A box around the image of `object`, larger by a few roundings of double.
[[nodiscard]] inline Bounds3d conservative_bounds(const Affine3d& world_from_object, const Bounds3d& object) {
  if (is_empty(object)) return object;
  const Affine3d& m = world_from_object;
  const Bounds3d world = transform_bounds(m, object);
  const Vec3d reach = max(abs(object.lower), abs(object.upper));
  const Vec3d size = abs(m.x) * reach.x + abs(m.y) * reach.y + abs(m.z) * reach.z + abs(m.origin);
  return {world.lower - size * 1e-14, world.upper + size * 1e-14};
}

/// Throws `Error` naming the node of a shape whose box in the world is further away than traversal can hold.
void check_reach(const Geometry& geometry, uint32_t object, const Bounds3d& world);

}  // namespace alhazen
