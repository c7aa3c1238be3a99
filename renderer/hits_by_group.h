// The hits of a wave in the order in which they are shaded.
#pragma once

#include "accel/wave.h"
#include "renderer/shading_groups.h"

namespace alhazen {

/// Numbers of a wave's rays, group after group, in each in the wave's order; what misses is one more group, the last.
struct HitsByGroup {
  /// Neighbours that hit one part of one object, or nothing.
  struct Run {
    uint32_t group, first, end;
  };
  Lanes<uint32_t> sorted;
  Lanes<uint32_t> ends;  // by group, in `sorted`
  Lanes<Run> runs;       // of the wave
};

/// Fills `out`, whose memory is reused.
void sort_by_group(const HitWave& hits, const Geometry& geometry, const ShadingGroups& groups, HitsByGroup& out);

}  // namespace alhazen
