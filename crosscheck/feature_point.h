// Points where surfaces are delicate.
#pragma once

#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

/// A random point, in the surface's own space and within rounding, of an edge, vertex, rim, apex or seam.
[[nodiscard]] Vec3d feature_point(const Surface& surface, Random& random);

}  // namespace alhazen::crosscheck
