// A tree of rays drawn.
#pragma once

#include <string>

#include "inspect/ray_tree.h"

namespace alhazen {

/// An SVG picture from left to right: branches as wide as their weight, boxes with what is hit and a swatch of the
/// light that comes from there. Of more rays than can be read, those that bring most are drawn; the others are counted
/// where they belong. Each box is a group of class "ray" whose data-ray is the ray's index.
[[nodiscard]] std::string tree_svg(const Scene& scene, const RayTree& tree);

}  // namespace alhazen
