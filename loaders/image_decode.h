// Textures from the bytes of their files.
#pragma once

#include <vector>

#include "loaders/gltf.h"
#include "materials/texture.h"

namespace alhazen {

/// Decodes all images in parallel. One that cannot be decoded stays empty (reads as white) with a warning; one that is
/// larger than the budget's limits is an error. An image's bytes are freed as soon as it is decoded.
[[nodiscard]] std::vector<TextureImage> decode_images(std::vector<EncodedImage> encoded, const WarningSink& warn,
                                                      LoadBudget& budget);
[[nodiscard]] std::vector<TextureImage> decode_images(std::vector<EncodedImage> encoded, const WarningSink& warn);

/// Decodes a scene's images into it, laid out as its materials look them up.
void decode_textures(LoadedScene& loaded, const WarningSink& warn);

}  // namespace alhazen
