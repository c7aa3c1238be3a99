// KHR_draco_mesh_compression: a primitive's triangles and attributes out of a Draco stream.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "loaders/gltf_accessor.h"

namespace alhazen {

/// What a stream held, in the shape that the primitive's accessors say. Movable: the views show bytes of `owned`.
struct DracoPrimitive {
  std::vector<uint32_t> index;                     // three for each triangle, in range
  std::map<std::string, AccessorView> attributes;  // those that the extension names
  std::vector<Bytes> owned;
};

/// Decodes the stream of `primitive`, which has the extension. Throws LoadError at the extension for a stream that
/// claims more vertices or triangles than the accessors have, before any memory is taken; for one that is malformed or
/// holds more than they have; and for attributes that it lacks or that do not fit their accessors.
[[nodiscard]] DracoPrimitive decode_draco(const JsonRef& primitive, const GltfBuffers& buffers);

}  // namespace alhazen
