// Smaller versions of a texture, for surfaces that show many texels in a pixel.
#pragma once

#include "materials/texture.h"

namespace alhazen {

/// How many texels all mip levels of an image have, down to one of 1 x 1.
[[nodiscard]] size_t texels_of_levels(int width, int height);

/// Appends the smaller levels of an image that has one: the texels of each are the means of 2 x 2 of the one before, of
/// colours as linear light.
void add_smaller_levels(TextureImage& image, ColorSpace space);

}  // namespace alhazen
