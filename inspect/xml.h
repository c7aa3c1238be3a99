// Text for SVG and HTML.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

namespace alhazen {

/// Any bytes as text between tags or in a quoted attribute; control characters, which XML has none of, become spaces.
[[nodiscard]] inline std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
  return out;
}

/// A coordinate to a hundredth.
[[nodiscard]] inline std::string short_decimal(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", std::round(100 * v) / 100);
  return text;
}

}  // namespace alhazen
