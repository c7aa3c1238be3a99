// Whitted's shading of one hit, whatever its material.
#pragma once

#include "renderer/pixel_sink.h"

namespace alhazen {

/// Shades hit `i` of the arena's wave: what it sends out goes to the sink, shadow rays to `shadow_by_light`, the rays
/// that it spawns to `spawned`.
template <bool observed>
void shade_hit(const Scene& scene, const RenderOptions& options, const PixelSink<observed>& sink, size_t i);

}  // namespace alhazen
