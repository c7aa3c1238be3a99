// glTF meshes: the triangles of their primitives.
#pragma once

#include <optional>
#include <vector>

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_source.h"

namespace alhazen {

/// As many meshes as the file has. Strips and fans become triangles, FB_ngon_encoding makes polygons of them; points
/// and lines are left out with a warning. Vertices that no index names are left out where they are many. Normals are
/// unit length; tangents are made where a material's normal texture needs them and the file has none. `materials` ends
/// with the default one; `variant` counts through KHR_materials_variants, none: the primitives' own materials. Throws
/// LoadError for accessors of the wrong shape or length, for vertex indices out of range, and for numbers that are not
/// finite.
[[nodiscard]] std::vector<Mesh> read_meshes(GltfSource& source, const GltfBuffers& buffers,
                                            const std::vector<Material>& materials,
                                            std::optional<size_t> variant = std::nullopt);

}  // namespace alhazen
