// A tree of rays as lines of text.
#pragma once

#include <string>

#include "inspect/ray_tree.h"

namespace alhazen {

/// Indented, a block of lines for each ray. `color`: swatches by escape sequences, for terminals.
[[nodiscard]] std::string tree_text(const Scene& scene, const RayTree& tree, bool color);

/// What the pixel sees, through what, and which branch dominates, in two or three sentences.
[[nodiscard]] std::string explanation(const Scene& scene, const RayTree& tree);

}  // namespace alhazen
