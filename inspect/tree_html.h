// A tree of rays as a page of its own, beside the picture.
#pragma once

#include <string>

#include "core/image.h"
#include "inspect/ray_tree.h"

namespace alhazen {

/// A picture, and where the pixel lies in it, in [0, 1] from the top left.
struct PixelPicture {
  ColorImage color;  // R, G, B, A, linear
  double u = 0, v = 0;
};

/// HTML that needs no other file: the picture with the pixel marked, the drawing, and the terms of the ray that the
/// pointer is on.
[[nodiscard]] std::string tree_html(const Scene& scene, const RayTree& tree, const PixelPicture& picture);

}  // namespace alhazen
