// From scene-linear colours, which have no upper end, to those of a display.
#pragma once

#include "core/image.h"
#include "core/vec.h"

namespace alhazen {

enum class ViewTransform : uint8_t {
  standard,     // clamped, then encoded as sRGB: colours below white are left as they are
  pbr_neutral,  // Khronos PBR Neutral: base colours come out as they went in, highlights are compressed
  agx,          // AgX: film-like, bright colours fade to white
  aces,         // the ACES 1.0 reference rendering transform, as fitted by Hill
  none,         // the linear numbers themselves, clamped and not encoded
};

/// The linear colour in [0, 1] whose sRGB encoding is what the display gets.
[[nodiscard]] Rgb display_linear(ViewTransform view, const Rgb& scene_linear) noexcept;

/// Applies it to the colours of a picture; where alpha is below 1, to the straight colours.
void apply(ViewTransform view, ColorImage& image);

}  // namespace alhazen
