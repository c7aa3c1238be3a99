// EXT_mesh_gpu_instancing: one mesh at many places.
#pragma once

#include "accel/mesh_instances.h"
#include "loaders/gltf_accessor.h"

namespace alhazen {

/// How many instances the extension object `r` of a node places. Throws LoadError at an attribute whose accessor has
/// another count than the others, or not the components that it needs.
[[nodiscard]] uint64_t instance_count(const JsonRef& r, const GltfBuffers& buffers);

/// Adds the places of the extension object `r` to `array`, but those where the map to the world cannot be inverted.
/// Throws LoadError for numbers that are not finite.
void read_instances(const JsonRef& r, const GltfBuffers& buffers, InstanceArray& array);

}  // namespace alhazen
