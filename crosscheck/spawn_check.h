// Whether rays that leave a surface, as the renderer spawns them, meet it again.
#pragma once

#include <functional>
#include <string>

#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

/// Flat or convex subjects of one family, so that what leaves outward must meet nothing, and what enters a closed body
/// must meet it.
struct SpawnTally {
  std::string family;
  uint64_t hits = 0;  // from each, one ray is spawned
  uint64_t self_hits = 0;
  std::string first_failure = {};  // as text
};

/// `hits` for each family: sphere, ellipsoid, cylinder, cone, box, disk, ring, polygon and star. Calls `done` for each,
/// in order.
void check_spawning(uint64_t hits, uint64_t seed, const std::function<bool()>& stop,
                    const std::function<void(const SpawnTally&)>& done);

}  // namespace alhazen::crosscheck
