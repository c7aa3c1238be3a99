// Drawings as SVG 1.1.
#pragma once

#include <string>

#include "reflectance/drawing.h"

namespace alhazen {

/// The marks alone, as elements to stand within an svg element.
[[nodiscard]] std::string marks_svg(const std::vector<Mark>& marks);

/// From <svg> to </svg>, on white; `more` are elements that lie over the marks.
[[nodiscard]] std::string drawing_svg(const Drawing& drawing, const std::string& more = {});

}  // namespace alhazen
