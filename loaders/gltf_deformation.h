// Which nodes show a mesh deformed, by morph targets or a skin, and what that makes of the mesh.
#pragma once

#include <span>
#include <vector>

#include "loaders/gltf_animation.h"
#include "loaders/gltf_mesh.h"
#include "loaders/gltf_nodes.h"
#include "loaders/gltf_skin.h"

namespace alhazen {

/// One deformed copy of a mesh.
struct Deformation {
  uint32_t mesh = 0;       // of the file
  uint32_t node = kNone;   // whose weights, skin and place these are; none: the weights are the mesh's own
  uint32_t skin = kNone;   // none: only morphed
  uint32_t placed_as = 0;  // Geometry's mesh that it becomes
  bool moves = false;      // the animations change it
};

struct DeformationPlan {
  std::vector<Deformation> all;
  std::vector<uint32_t> mesh_of_node;  // Geometry's, kNone where the node has none
  std::vector<char> in_world;          // by node, whether its mesh is deformed into world space: it has a skin
  std::vector<char> deformable;        // by mesh of the file
  size_t mesh_count = 0;  // of Geometry: the file's, and the copies of those that are shown in several ways
};

/// Which properties the channels change.
struct Movement {
  std::vector<char> nodes;         // by node: its global map or its visibility
  std::vector<char> node_weights;  // by node
  std::vector<char> mesh_weights;  // by mesh
  bool materials = false;
};
[[nodiscard]] Movement movement(const GltfSource& source, const Forest& forest, std::span<const Channel> channels);

/// A mesh without a skin whose weights are 0 and stay so is not deformed. Nodes without a skin and weights of their own
/// share what their mesh's weights make.
[[nodiscard]] DeformationPlan plan_deformations(const GltfSource& source, std::span<const uint32_t> shown,
                                                const Movement& movement);

/// Throws LoadError for a joint that its skin does not have, for weights that are not as many as the targets, and where
/// all copies together are larger than what a file of that many bytes may ask for. Warns of primitives that a skin does
/// not hold: they follow their node.
void check_deformations(GltfSource& source, const std::vector<std::vector<GltfPrimitive>>& deformable,
                        std::span<const Skin> skins, const DeformationPlan& plan);

/// The mesh at the weights that the JSON has now, under its skin in world space, else in its own.
[[nodiscard]] Mesh deformed(const GltfSource& source, const std::vector<GltfPrimitive>& rest, const Deformation& how,
                            std::span<const Skin> skins, std::span<const Affine3d> world_from_node,
                            const std::vector<Material>& materials);

}  // namespace alhazen
