// Drawings as pixels.
#pragma once

#include "reflectance/drawing.h"

namespace alhazen {

/// R, G, B, A, linear, on white; `scale` pixels for each of the drawing's. Without words where the machine has no font.
[[nodiscard]] ColorImage drawing_picture(const Drawing& drawing, int scale);

}  // namespace alhazen
