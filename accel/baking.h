// Moving meshes to world space, where some of them change with time.
#pragma once

#include <span>

#include "accel/geometry.h"

namespace alhazen {

/// `bake_single_instances`, but meshes whose flag in `moving` is set stay as they are, shown or not. `moving` may be
/// empty.
void bake_single_instances(Geometry& geometry, std::span<const char> moving);

}  // namespace alhazen
