// Mattes made visible.
#pragma once

#include <span>

#include "core/image.h"
#include "renderer/layer.h"

namespace alhazen {

/// R, G, B, A, linear, for an 8-bit file: each name of a Cryptomatte layer in a colour of its own, mixed by coverage
/// over black, and beside it the names with their shares of the picture, the largest first. It is made of what files
/// hold alone: ids, coverages and the manifest. `images`: all of one layer.
[[nodiscard]] ColorImage matte_picture(std::span<const LayerImage> images, int width, int height);

}  // namespace alhazen
