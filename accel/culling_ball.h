// A ball around a placed shape, and the test that rays of a packet must pass before anything costlier is done for them.
#pragma once

#include <cstdint>

#include "accel/ray_rows.h"
#include "accel/shape_hits.h"

namespace alhazen {

/// In world space. A quarter of a cache line, where the shape takes several.
struct CullingBall {
  float x, y, z;         // the centre
  float squared_radius;  // rounded up
};

/// Contains every point of the placed shape, whose bounds in its own space are `object_bounds`. Tight for spheres and
/// round quadrics that are not stretched.
[[nodiscard]] CullingBall culling_ball(const PlacedShape& placed, const Bounds3d& object_bounds);

/// The lanes of a packet of 1, 4, 8 or 16 rays whose `valid` is not 0 and that may meet the ball in [t_min, t_max]: bit
/// k stands for lane k. What is left out surely misses, even by a parameter that is rounded to float.
[[nodiscard]] uint32_t lanes_that_may_meet(const CullingBall& ball, const RayRows& rays, const int* valid) noexcept;

}  // namespace alhazen
