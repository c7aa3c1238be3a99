// Closed meshes that leak easily, for rays aimed at their vertices and edges.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "crosscheck/random.h"

namespace alhazen::crosscheck {

struct ClosedMesh {
  std::string name;
  std::vector<Vec3d> vertices;                 // floats
  std::vector<std::array<uint32_t, 3>> faces;  // counter-clockwise seen from outside
  Vec3d center;                                // a point well inside, from where every ray leaves once; floats
  double outside;                              // further from the centre than any vertex
};

/// bumpy: 16 x 16 facets, radii 1 to 6, about the origin; bumpy-far: the same about (148376, 1234, -223423); box; fan:
/// a thousand times as high as wide, of 32 needles.
[[nodiscard]] std::vector<ClosedMesh> closed_meshes(uint64_t seed);

}  // namespace alhazen::crosscheck
