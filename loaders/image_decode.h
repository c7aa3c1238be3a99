// Textures from the bytes of their files.
#pragma once

#include <vector>

#include "loaders/gltf.h"
#include "materials/texture.h"

namespace alhazen {

/// Decodes all images in parallel. One that cannot be decoded stays empty (reads as white) with a warning.
[[nodiscard]] std::vector<TextureImage> decode_images(const std::vector<EncodedImage>& encoded,
                                                      const WarningSink& warn);

}  // namespace alhazen
