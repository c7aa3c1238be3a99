// Brightness of a finished picture.
#pragma once

#include "core/image.h"

namespace alhazen {

/// Multiplies the colours by 2^stops; alpha stays.
void expose(ColorImage& image, float stops);

/// How much of a picture an 8-bit file shows as plain white.
struct Clipping {
  double share = 0;  // of the pixels: those with every channel above 1
  float stops = 0;   // what `expose` would have to add to keep all but a hundredth of the picture; 0 or less
};

[[nodiscard]] Clipping clipping(const ColorImage& image);

}  // namespace alhazen
