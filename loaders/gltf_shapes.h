// ALHAZEN_shapes: analytic surfaces described in JSON.
#pragma once

#include <vector>

#include "accel/shape.h"
#include "loaders/json_check.h"
#include "loaders/load_limits.h"

namespace alhazen {

/// What an element of the extension's `shapes` has to look like: exactly one key that names a kind, and its fields.
[[nodiscard]] Check shape_description();

/// The file's shapes in their order, from the checked extension object.
[[nodiscard]] std::vector<Shape> read_shapes(const JsonRef& extension, LoadBudget& budget);

}  // namespace alhazen
