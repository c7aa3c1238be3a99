// Pictures back from files, as this program writes them.
#pragma once

#include <filesystem>

#include "core/image.h"

namespace alhazen {

/// R, G, B, scene-linear: 8-bit files are decoded from sRGB. Throws LoadError.
[[nodiscard]] ColorImage read_picture(const std::filesystem::path& file);

/// A scene signature: the 32-bit UINT channels node, primitive and material. Throws LoadError where they are not there.
[[nodiscard]] IdImage read_signature(const std::filesystem::path& file);

}  // namespace alhazen
