// Images from and to files: the only code that knows OpenImageIO.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"
#include "loaders/gltf.h"
#include "materials/texture.h"

namespace alhazen {

/// Decodes all images in parallel. One that cannot be decoded stays empty (reads as white) with a warning.
[[nodiscard]] std::vector<TextureImage> decode_images(const std::vector<EncodedImage>& encoded,
                                                      const WarningSink& warn);

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Throws WriteError where `file` cannot be written: unknown format, missing folder, no permission. Leaves nothing
/// behind.
void check_writable(const std::filesystem::path& file);

/// Writes beside `file`, then renames: `file` is the old one or complete. EXR holds linear 32-bit floats, every other
/// format sRGB, clamped to [0, 1], 8 bits. Throws WriteError.
void write_image(const std::filesystem::path& file, const ColorImage& image, const Metadata& metadata);

/// EXR: the 32-bit UINT channels node, primitive, material. Other formats: a distinct, stable colour for each node.
void write_image(const std::filesystem::path& file, const IdImage& image, const Metadata& metadata);

}  // namespace alhazen
