// A tree of rays as a scene of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "inspect/ray_tree.h"

namespace alhazen {

/// Binary glTF in the scene's own space: each ray, and each shadow ray, is a node named after its kind and the nodes
/// that it goes between; for Alhazen a cylinder (ALHAZEN_shapes), the thicker the more it weighs, for other viewers a
/// line. There is no camera: viewers show all of it. Rays that leave the scene end a third of its size away.
[[nodiscard]] std::vector<uint8_t> tree_glb(const Scene& scene, const RayTree& tree);

}  // namespace alhazen
