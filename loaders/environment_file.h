// Environments from files.
#pragma once

#include <filesystem>

#include "renderer/environment.h"

namespace alhazen {

/// Reads an equirectangular image (.hdr, .exr, or another that OpenImageIO reads) and prefilters it. Values below 0 or
/// not finite become 0. Throws LoadError for a file that is missing, no image, or larger than 32768 x 16384 pixels.
[[nodiscard]] Environment load_environment(const std::filesystem::path& file);

}  // namespace alhazen
