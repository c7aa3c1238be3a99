// From a pixel to its tree of rays.
#pragma once

#include "inspect/ray_tree.h"

namespace alhazen {

/// The rays of one sample of the pixel (x, y), which must be in the picture. The pixel's cell is traced as `render`
/// traces it, all samples of it, so that the tree is the picture's own to the bit.
[[nodiscard]] RayTree trace_pixel(const Scene& scene, const AcceleratedScene& accelerated, const Camera& camera,
                                  const RenderOptions& options, int x, int y, int sample);

}  // namespace alhazen
