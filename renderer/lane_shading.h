// Whitted's shading of several hits of one material side by side: what it is of each, to the bit, when it is shaded
// alone (renderer/hit_shading.h).
#pragma once

#include <vector>

#include "renderer/lane_surfaces.h"
#include "renderer/phase_clock.h"
#include "renderer/shading_groups.h"

namespace alhazen {

/// Rays that leave the hits, for the lanes whose bit is set.
struct LaneRays {
  uint32_t lanes = 0;
  Vec3Array<ShadingLanes> origin, direction;
  LaneArray<ShadingLanes> t_max;        // of shadow rays
  LaneArray<ShadingLanes> cone_spread;  // of the others
  RgbArray<ShadingLanes> weight;        // what they bring
};

/// What goes in: hits, and what is left of their rays.
struct LaneWork {
  LaneHits hits;
  RgbArray<ShadingLanes> weight;                    // of the rays, where they arrive
  LaneArray<ShadingLanes> cone_width, cone_spread;  // of the rays, at the hits
  LaneArray<ShadingLanes> roughness;                // of the surfaces that sent the rays
  LaneArray<UintOf<ShadingLanes>> pixel, depth;     // of the rays
};

/// What comes out.
struct LaneLight {
  bool emits = false, reflects = false;      // whether the material does
  RgbArray<ShadingLanes> emission, ambient;  // weighed, where it does
  std::vector<LaneRays> shadow;              // by light
  LaneRays straight, mirror, refracted;
  LaneArray<ShadingLanes> alpha;      // the surface's coverage, where a ray goes straight on
  LaneArray<ShadingLanes> roughness;  // of the surface, where others leave it
};

/// The clock is in Phase::shading before and after.
void shade_lanes(const Scene& scene, const ShadingGroup& group, const LaneWork& work, PhaseClock& clock,
                 LaneLight& out);

}  // namespace alhazen
