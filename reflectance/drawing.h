// A drawing as plain data: laid out once, written as lines (.svg, .html) or as pixels (.png).
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/image.h"
#include "core/vec.h"

namespace alhazen {

/// sRGB bytes, and how much of it covers what lies below.
struct Ink {
  uint8_t r = 0, g = 0, b = 0;
  double opacity = 1;
};

inline constexpr Ink kNoInk{0, 0, 0, 0};

/// Straight lines from point to point; filled by the even-odd rule as if closed.
struct Outline {
  std::vector<Vec2d> points;
  Ink line, fill = kNoInk;
  double width = 1;
  double dash = 0;  // length of the dashes and of the gaps between them; 0: none
};

enum class Anchor : uint8_t { start, middle, end };

/// One line of text, its baseline at `at`.
struct Words {
  Vec2d at;
  std::string text;  // UTF-8
  double size = 11;
  Ink ink;
  Anchor anchor = Anchor::start;
};

/// Pixels laid over a square box.
struct Inset {
  Vec2d at;          // upper left corner
  double side;       // drawn so wide and high
  ColorImage image;  // R, G, B, A, linear, straight alpha; as wide as high, 2 pixels at least
};

using Mark = std::variant<Outline, Words, Inset>;

/// What lies in the picture, the later over the earlier; x right, y down, in pixels of the web.
struct Drawing {
  double width = 0, height = 0;
  std::vector<Mark> marks;
};

[[nodiscard]] Outline line(const Vec2d& from, const Vec2d& to, const Ink& ink, double width = 1, double dash = 0);
[[nodiscard]] Outline filled_box(const Vec2d& corner, double width, double height, const Ink& fill);

/// From one angle to another, radians from the x axis towards -y, drawn as short lines.
[[nodiscard]] Outline arc(const Vec2d& centre, double radius, double from, double to, const Ink& ink, double width = 1);
[[nodiscard]] Outline circle(const Vec2d& centre, double radius, const Ink& line_ink, const Ink& fill,
                             double width = 1);

}  // namespace alhazen
