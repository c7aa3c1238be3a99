// Round surfaces as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace alhazen {

struct TriangleSoup {
  std::vector<Vec3f> positions, normals;  // one normal a position, unit, outward
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// The unit sphere about the origin, poles on y: `segments` around, half as many from pole to pole, at least 3.
[[nodiscard]] TriangleSoup tessellated_sphere(int segments);

/// The wall of the frustum about y between y = -height / 2 and height / 2; one of the radii may be 0.
[[nodiscard]] TriangleSoup tessellated_frustum(double height, double radius_bottom, double radius_top, int segments);

}  // namespace alhazen
