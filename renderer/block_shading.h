// A block of a wave's hits shaded side by side: gathered from the wave's rows, and what it spawns appended to others.
#pragma once

#include <span>

#include "renderer/whitted.h"

namespace alhazen {

/// Shades hits of the arena's wave, at most as many as there are lanes, in rising order and all of one group that
/// allows lanes. Does to the arena and to `radiance` what shading them one by one does (renderer/hit_shading.h).
void shade_block(const Scene& scene, const RenderOptions& options, const ShadingGroup& group,
                 std::span<const uint32_t> hits, WaveArena& arena, Rgb* radiance);

}  // namespace alhazen
