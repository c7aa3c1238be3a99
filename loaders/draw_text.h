// Words in pictures: captions and legends.
#pragma once

#include <string>

#include "core/image.h"
#include "core/vec.h"

namespace alhazen {

/// Writes one line with its left end at x and its baseline at y, `height` pixels the size of the type. False, and
/// nothing is drawn, where the machine has no font for it.
bool draw_text(ColorImage& image, int x, int y, const std::string& text, int height, const Rgb& color);

/// How far that line would reach from its left end, in pixels; 0 where the machine has no font.
[[nodiscard]] int text_width(const std::string& text, int height);

}  // namespace alhazen
