// How much is reflected, by angle.
#pragma once

#include "reflectance/brdf_report.h"
#include "reflectance/drawing.h"

namespace alhazen {

/// Curves over the angle to the normal, in a box, with their legend below it: beams reflected; where that differs, what
/// a white furnace shows; R and T, the shares of rays. What lies above 1 is marked.
[[nodiscard]] std::vector<Mark> albedo_plot(const BrdfCheck& check, const Vec2d& corner, double width, double height);

}  // namespace alhazen
