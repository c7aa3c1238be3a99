// A picture with a column of colours and what they stand for beside it.
#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "core/vec.h"

namespace alhazen {

struct LegendRow {
  Rgb color;         // linear
  std::string name;  // cut where it is too long
  std::string note;  // on the right
};

/// R, G, B, A, linear. What has no room in the picture's height, or in that of a few rows, is counted in a last row.
/// Without words where the machine has no font.
[[nodiscard]] ColorImage with_legend(const ColorImage& picture, const std::vector<LegendRow>& rows);

}  // namespace alhazen
