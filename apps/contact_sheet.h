// Many pictures on one page, each with its caption.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/vec.h"

namespace alhazen {

struct SheetCell {
  std::string title, facts;  // a line each below the picture; the title keeps its end where it is too long
  ColorImage picture;        // R, G, B, linear; empty: there is none
  bool failed = false;       // the caption warns
};

struct SheetLayout {
  int picture_width = 320, picture_height = 240;  // pixels; each cell's picture has this size
  int columns = 0;                                // 0: about as wide as high
};

/// Width and height of the page in pixels.
[[nodiscard]] std::array<int, 2> sheet_size(const SheetLayout& layout, size_t cells);

/// In rows from the top left, R, G, B, A, linear. Without captions where the machine has no font.
[[nodiscard]] ColorImage contact_sheet(const SheetLayout& layout, const std::vector<SheetCell>& cells);

}  // namespace alhazen
