// glTF scenes: the nodes that are shown, and the meshes, shapes, cameras and lights that they place.
#pragma once

#include <optional>
#include <span>

#include "loaders/gltf_deformation.h"

namespace alhazen {

/// The nodes as they stand at one time.
struct PosedNodes {
  std::optional<size_t> scene;  // that is shown
  const Forest& forest;
  std::span<const uint32_t> shown;  // the scene's, see `scene_nodes`
  std::span<const Affine3d> world_from_node;
  const DeformationPlan& deformations;
  bool counted = false;  // what their instances take is in the budget already
};

/// Adds what nodes bring to a scene whose materials, meshes and shapes are there already: instances, cameras, lights,
/// ambient light and background. Shown are `shown`, less what KHR_node_visibility hides and MSFT_lod's lesser levels;
/// hidden cameras are there all the same. Throws LoadError for shapes placed by a matrix that cannot be inverted, and
/// where instances unfold to too many.
void read_scene(GltfSource& source, const GltfBuffers& buffers, const PosedNodes& nodes, Scene& scene);

}  // namespace alhazen
