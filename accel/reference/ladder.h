// All reference accelerators of a scene, simplest first.
#pragma once

#include <memory>
#include <string>

#include "accel/reference/screen_boxes.h"

namespace alhazen {

struct Rung {
  std::string name;
  std::unique_ptr<ReferenceAccelerator> accelerator;
};

/// Everything, a box for each object, the node tree, rectangles in the image of the camera that `projection` tells of.
/// `geometry` and the filter's data must outlive them.
[[nodiscard]] std::vector<Rung> reference_ladder(const Geometry& geometry, const SurfaceFilter& filter,
                                                 const FilmProjection& projection);

}  // namespace alhazen
