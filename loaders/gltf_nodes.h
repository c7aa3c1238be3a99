// The nodes of a glTF file: whose child each is, where it stands, and whether it is seen.
#pragma once

#include <optional>
#include <vector>

#include "core/transform.h"
#include "loaders/gltf_source.h"

namespace alhazen {

/// Every node has one parent at most and none is its own ancestor.
struct Forest {
  std::vector<uint32_t> parent;  // kNone: a root
  std::vector<uint32_t> order;   // all nodes, each after its parent
};

/// Throws LoadError for a node graph that is no forest.
[[nodiscard]] Forest read_forest(const GltfSource& source);

/// Nodes and all below them, each after its parent.
[[nodiscard]] std::vector<uint32_t> below(const GltfSource& source, std::vector<uint32_t> nodes);

/// What hangs from the scene `chosen`, or from all roots where there is none, in the order of the nodes. Throws
/// LoadError for scene nodes that are no roots or stand twice.
[[nodiscard]] std::vector<uint32_t> scene_nodes(const GltfSource& source, const Forest& forest,
                                                std::optional<size_t> chosen);

/// The global maps of all nodes, as the JSON has them now. Throws LoadError for matrices that are not affine.
[[nodiscard]] std::vector<Affine3d> world_from_nodes(const GltfSource& source, const Forest& forest);

/// By node, whether it, or one above it, is hidden by KHR_node_visibility or is a lesser level of MSFT_lod.
[[nodiscard]] std::vector<char> hidden_nodes(const GltfSource& source, const Forest& forest);

/// Makes flags hold for what hangs from the nodes that have them, too.
void inherit(const Forest& forest, std::vector<char>& flags);

}  // namespace alhazen
