// glTF meshes: the triangles of their primitives.
#pragma once

#include <optional>
#include <vector>

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_primitive.h"
#include "loaders/gltf_source.h"

namespace alhazen {

struct GltfMeshes {
  std::vector<Mesh> meshes;  // as many as the file has, at rest
  // By mesh, a primitive for each part of those that are deformable.
  std::vector<std::vector<GltfPrimitive>> deformable;
};

/// Strips and fans become triangles, FB_ngon_encoding makes polygons of them; points and lines are left out with a
/// warning. Vertices that no index names are left out where they are many. Normals are unit length; tangents are made
/// where a material's normal texture needs them and the file has none. `materials` ends with the default one; `variant`
/// counts through KHR_materials_variants, none: the primitives' own materials; `deformable` says of each mesh whether
/// its morph targets and joints are wanted. Throws LoadError for accessors of the wrong shape or length, for vertex
/// indices out of range, and for numbers that are not finite.
[[nodiscard]] GltfMeshes read_meshes(GltfSource& source, const GltfBuffers& buffers,
                                     const std::vector<Material>& materials, std::optional<size_t> variant,
                                     const std::vector<char>& deformable);

}  // namespace alhazen
