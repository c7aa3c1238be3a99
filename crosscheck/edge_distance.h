// How near a ray comes to where its answer changes.
#pragma once

#include <optional>

#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

struct EdgeDistance {
  double ulp = 0;            // signed: positive where the line meets the surface, negative where it passes by
  const char* feature = "";  // "edge", "vertex", "rim", "apex", "silhouette"
};

/// The nearest edge, vertex, rim, apex or silhouette. Each is where a polynomial in the ray's numbers is 0 (the product
/// of the direction with two vertices, the discriminant, the wall at a cap's plane, the difference of two planes'
/// parameters); the distance is its value, in units of 2^-24 of the sum of its terms' magnitudes. For an edge that is
/// about how many roundings to float the ray is from a tie; for a silhouette D radii away, they are about D / 2 times
/// as many. It does not depend on the length of the direction. In binary128.
///
/// none   for rays that are not finite or have no direction, and where no such place is near the line.
/// whole  of the line: t_min and t_max are left out of it. Composites: of their operands, hidden parts too.
[[nodiscard]] std::optional<EdgeDistance> edge_distance(const Subject& subject, const Rayf& ray_world);

}  // namespace alhazen::crosscheck
