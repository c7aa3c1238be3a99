// glTF skins: the joints that hold a mesh.
#pragma once

#include <span>
#include <vector>

#include "core/transform.h"
#include "loaders/gltf_accessor.h"

namespace alhazen {

struct Skin {
  std::vector<uint32_t> joints;           // nodes
  std::vector<Affine3d> joint_from_rest;  // the inverse bind matrices: from the mesh at rest to each joint
};

/// All of the file's skins. Without inverse bind matrices they are the identity; their last row counts as 0 0 0 1.
/// Throws LoadError where they are fewer than the joints, no 4 x 4 matrices, or not finite.
[[nodiscard]] std::vector<Skin> read_skins(const GltfSource& source, const GltfBuffers& buffers);

/// By joint, the map from the mesh at rest to the world.
[[nodiscard]] std::vector<Affine3d> world_from_rest(const Skin& skin, std::span<const Affine3d> world_from_node);

}  // namespace alhazen
