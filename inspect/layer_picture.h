// A layer made visible.
#pragma once

#include "core/image.h"
#include "core/vec.h"
#include "renderer/layer.h"

namespace alhazen {

/// Blue, green, yellow for t in [0, 1], linear: even steps look even, darker is always less ("viridis", as a polynomial
/// by M. Zucker).
[[nodiscard]] Rgb heat_color(float t) noexcept;

/// R, G, B, A, linear, for an 8-bit file: colours as they are, directions about grey, positions from the least to the
/// most, ids as `node_color`, and single numbers as heat with their scale beside them.
[[nodiscard]] ColorImage layer_picture(const LayerImage& layer, int width, int height);

}  // namespace alhazen
