// Whitted's shading of several hits of one material side by side: what it is of each, to the bit, when it is shaded
// alone (renderer/whitted.cpp).
#pragma once

#include <vector>

#include "renderer/shading_groups.h"

namespace alhazen {

/// Rays that leave the hits, for the lanes whose bit is set.
struct LaneRays {
  uint32_t lanes = 0;
  Vec3Array<ShadingLanes> origin, direction;
  LaneArray<ShadingLanes> t_max;  // of shadow rays
  RgbArray<ShadingLanes> weight;  // what they bring
};

/// What goes in: hits, and what is left of their rays.
struct LaneWork {
  LaneHits hits;
  RgbArray<ShadingLanes> weight;       // of the rays, where they arrive
  LaneArray<ShadingLanes> cone_width;  // of the rays, at the hits
};

/// What comes out.
struct LaneLight {
  RgbArray<ShadingLanes> emission, ambient;  // weighed
  std::vector<LaneRays> shadow;              // by light
  LaneRays mirror, refracted;
  // Where they leave from: what widens their cones. `n`: the normal that shades, towards where the ray came from.
  Vec3Array<DoubleOf<ShadingLanes>> p_world;
  Vec3Array<ShadingLanes> ng_world, ns_world, n;
  LaneArray<ShadingLanes> eta;
  LaneArray<ShadingLanes> roughness;  // of the surface
};

void shade_lanes(const Scene& scene, const ShadingGroup& group, const LaneWork& work, LaneLight& out);

}  // namespace alhazen
