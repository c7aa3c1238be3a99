// EXT_mesh_gpu_instancing: one mesh at many places.
#pragma once

#include <vector>

#include "core/transform.h"
#include "loaders/gltf_accessor.h"

namespace alhazen {

/// How many instances the extension object `r` of a node places. Throws LoadError at an attribute whose accessor has
/// another count than the others, or not the components that it needs.
[[nodiscard]] uint64_t instance_count(const JsonRef& r, const GltfBuffers& buffers);

/// The maps from instances [first, first + count) to their node: translation x rotation x scale. Throws LoadError for
/// numbers that are not finite.
[[nodiscard]] std::vector<Affine3f> read_instances(const JsonRef& r, const GltfBuffers& buffers, uint64_t first,
                                                   uint64_t count);

}  // namespace alhazen
