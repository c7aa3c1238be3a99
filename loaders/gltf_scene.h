// glTF scenes: the nodes that are shown, and the meshes, shapes, cameras and lights that they place.
#pragma once

#include <optional>

#include "loaders/gltf_accessor.h"

namespace alhazen {

/// Fills what nodes bring to a scene whose materials, meshes and shapes are there already: instances, cameras, lights,
/// names, ambient light and background. Shown is what hangs from the scene `chosen`, or from all roots where
/// there is none, less what KHR_node_visibility hides and MSFT_lod's lesser levels; hidden cameras are there all the
/// same. Throws LoadError for a node graph that is no forest, scene nodes that are no roots, matrices that are not
/// affine, and shapes placed by a matrix that cannot be inverted.
void read_scene(GltfSource& source, const GltfBuffers& buffers, std::optional<size_t> chosen, Scene& scene);

}  // namespace alhazen
