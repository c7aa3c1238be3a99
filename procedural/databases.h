// Haines' Standard Procedural Databases: scenes of any size for measuring ray tracers, well known since 1987.
#pragma once

#include <string>
#include <vector>

#include "procedural/nff.h"

namespace alhazen {

/// One of them. `size` sets how many objects there are, `default_size` as in the literature.
struct Database {
  std::string name;
  std::string description;
  int default_size, largest_size;
  NffScene (*make)(int size);
};

/// Balls, gears, mountain, rings, teapot, tetra, tree. Numbers of objects, lights, materials and views are those of
/// the paper (and its databases' 3rd revision); where chance decides (the mountain), it is ours.
[[nodiscard]] const std::vector<Database>& databases();

}  // namespace alhazen
