// From crossings to hits: those within a ray's range, parameters rounded once to float, doubts settled.
#pragma once

#include <vector>

#include "accel/line_map.h"
#include "accel/shape.h"
#include "core/ray.h"

namespace alhazen {

struct ShapeHit {
  float t;        // in lengths of the ray's direction
  uint32_t face;  // which part of the surface, as the shape counts them
};

/// Where and how a shape stands in the world. The map and the shape must outlive it.
struct PlacedShape {
  LineMap<double> object_from_world;
  const Affine3d* world_from_object;
  const Shape* shape;
};

/// How often the calling thread's rays needed more than double.
struct DoubtCounts {
  uint64_t quad = 0, exact = 0;
};
[[nodiscard]] DoubtCounts& doubt_counts() noexcept;

/// Appends all hits with t_min <= t <= t_max, nearest first. Rays that are not finite, or without direction, hit
/// nothing.
///
/// accuracy  hit or miss, order and face are those of exact arithmetic on the given numbers; t is correctly rounded but
///           where double cannot tell (an error below 2^-37 relative): then one of the two floats beside it.
/// cost      double, then binary128 for the doubtful, then rational numbers for what is left: see `doubt_counts`.
void append_hits(const PlacedShape& placed, const Rayf& ray_world, std::vector<ShapeHit>& hits);

/// The first hit in range for a packet's lanes.
struct NearestLanes {
  DoubleLanes t, face;     // t as rounded to float
  LaneMask hit, doubtful;  // doubtful lanes: ask `append_hits`
};

inline DoubleLanes rounded_to_float(const DoubleLanes& x) {
  std::array<float, DoubleLanes::size()> buffer;
  x.copy_to(buffer.data(), std::experimental::element_aligned);
  return DoubleLanes(buffer.data(), std::experimental::element_aligned);
}

[[nodiscard]] inline NearestLanes nearest(const LineCrossings<DoubleLanes>& crossings, const DoubleLanes& t_min,
                                          const DoubleLanes& t_max) {
  NearestLanes found{DoubleLanes(0), DoubleLanes(0), LaneMask(false), crossings.doubtful};
  for (const auto& c : crossings.at) {
    const LaneMask candidate =
        c.present && !found.hit && !found.doubtful && !(c.t + c.error < t_min) && !(c.t - c.error > t_max);
    found.doubtful = found.doubtful || (candidate && !(c.error <= absolute(c.t) * kParameterAccuracy));
    const DoubleLanes t = rounded_to_float(c.t);
    const LaneMask hit = candidate && !found.doubtful && t >= t_min && t <= t_max;
    found.t = select(hit, t, found.t), found.face = select(hit, c.face, found.face);
    found.hit = found.hit || hit;
  }
  return found;
}

/// Whether anything is hit in range: no parameter need be accurate.
struct BlockedLanes {
  LaneMask blocked, doubtful;
};
[[nodiscard]] inline BlockedLanes blocked(const LineCrossings<DoubleLanes>& crossings, const DoubleLanes& t_min,
                                          const DoubleLanes& t_max) {
  BlockedLanes found{LaneMask(false), crossings.doubtful};
  for (const auto& c : crossings.at) {
    found.blocked = found.blocked || (c.present && c.t - c.error > t_min && c.t + c.error < t_max);
    found.doubtful = found.doubtful || (c.present && !(c.t + c.error < t_min) && !(c.t - c.error > t_max));
  }
  found.blocked = found.blocked && !crossings.doubtful;
  found.doubtful = found.doubtful && !found.blocked;
  return found;
}

}  // namespace alhazen
