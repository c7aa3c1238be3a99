// glTF images and textures, with the extensions that bring other formats.
#pragma once

#include <vector>

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_material.h"
#include "loaders/gltf_source.h"

namespace alhazen {

struct GltfTextures {
  std::vector<Texture> textures;     // the file's, then those that `materials.roughness` asks for
  std::vector<EncodedImage> images;  // the file's, then one for each of those; none of what no material uses
};

/// A texture takes the image of the best format that is decoded here: KHR_texture_basisu's where the build has libktx,
/// EXT_texture_webp's, MSFT_texture_dds's, else its own. One that has none of them stays without an image, with a
/// warning: the material's factors are seen. So does an image that cannot be read.
[[nodiscard]] GltfTextures read_textures(GltfSource& source, const GltfBuffers& buffers,
                                         const GltfMaterials& materials);

/// An image's own bytes; none, with a warning, where they cannot be read.
[[nodiscard]] Bytes read_image(GltfSource& source, const GltfBuffers& buffers, const JsonRef& image);

}  // namespace alhazen
