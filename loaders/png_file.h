// PNG files, encoded by libpng itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loaders/image_file.h"

namespace alhazen {

/// The bytes of a file of 8-bit sRGB pixels, R, G, B and with four channels straight A. Throws std::runtime_error with
/// libpng's reason.
[[nodiscard]] std::vector<uint8_t> encoded_png(int width, int height, int channels, std::span<const uint8_t> pixels,
                                               const Metadata& metadata);

/// Of the library.
[[nodiscard]] const char* libpng_version();

}  // namespace alhazen
