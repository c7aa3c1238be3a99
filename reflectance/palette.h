// The colours of reflectance drawings, on white.
#pragma once

#include <array>

#include "reflectance/drawing.h"

namespace alhazen {

inline constexpr Ink kTextInk{34, 38, 44}, kFaintInk{118, 124, 134}, kGridInk{222, 225, 230}, kAxisInk{90, 96, 106};
inline constexpr Ink kGoodInk{24, 138, 84}, kBadInk{200, 44, 36};

/// Colours that the colour-blind tell apart (M. Okabe, K. Ito, Color Universal Design, 2008).
inline constexpr std::array kCurveInks{Ink{0, 114, 178},   Ink{213, 94, 0},  Ink{0, 158, 115},
                                       Ink{204, 121, 167}, Ink{230, 159, 0}, Ink{86, 180, 233}};
[[nodiscard]] inline constexpr Ink curve_ink(size_t i) { return kCurveInks[i % kCurveInks.size()]; }

[[nodiscard]] inline constexpr Ink faded(Ink ink, double opacity) {
  ink.opacity = opacity;
  return ink;
}

}  // namespace alhazen
