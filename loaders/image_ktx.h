// KTX 2 images, Basis Universal ones too, where the build found libktx.
#pragma once

#include <cstdint>
#include <span>

#include "materials/texture.h"

namespace alhazen {

#ifdef ALHAZEN_KTX
inline constexpr bool kDecodesKtx = true;
#else
inline constexpr bool kDecodesKtx = false;
#endif

/// Level 0 of the first layer and face, 8 bits for each channel. Throws std::runtime_error for a file that is damaged,
/// a format that libktx does not unpack, or a build without it.
[[nodiscard]] TextureImage decode_ktx(std::span<const uint8_t> file);

}  // namespace alhazen
