// Smaller versions of a texture, for surfaces that show many texels in a pixel.
#pragma once

#include "materials/texture.h"

namespace alhazen {

/// Fills `image.smaller`: each level half as wide and high as the one before (rounded down, at least 1), its texels the
/// means of 2 x 2, of colours as linear light.
void add_smaller_levels(TextureImage& image, ColorSpace space);

}  // namespace alhazen
