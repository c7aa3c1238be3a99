// glTF images, textures and materials, with the KHR and ALHAZEN extensions of materials.
#pragma once

#include <vector>

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_source.h"

namespace alhazen {

/// The bytes of every image; none, with a warning, for one that cannot be read.
[[nodiscard]] std::vector<EncodedImage> read_images(GltfSource& source, const GltfBuffers& buffers);

[[nodiscard]] std::vector<Texture> read_textures(const GltfSource& source);

/// The file's materials, then glTF's default one.
[[nodiscard]] std::vector<Material> read_materials(const GltfSource& source);

}  // namespace alhazen
