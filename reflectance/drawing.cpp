#include "reflectance/drawing.h"

#include <numbers>

namespace alhazen {

Outline line(const Vec2d& from, const Vec2d& to, const Ink& ink, double width, double dash) {
  return {.points = {from, to}, .line = ink, .width = width, .dash = dash};
}

Outline filled_box(const Vec2d& corner, double width, double height, const Ink& fill) {
  const auto [x, y] = corner;
  return {.points = {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}, .line = kNoInk, .fill = fill};
}

Outline arc(const Vec2d& centre, double radius, double from, double to, const Ink& ink, double width) {
  constexpr int kSteps = 96;
  Outline path{.points = {}, .line = ink, .width = width};
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = from + (to - from) * i / kSteps;
    path.points.push_back(centre + radius * Vec2d{std::cos(angle), -std::sin(angle)});
  }
  return path;
}

Outline circle(const Vec2d& centre, double radius, const Ink& line_ink, const Ink& fill, double width) {
  Outline path = arc(centre, radius, 0, 2 * std::numbers::pi, line_ink, width);
  path.fill = fill;
  return path;
}

}  // namespace alhazen
