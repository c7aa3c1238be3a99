// Where a line crosses a surface, in interval arithmetic: the judge's first instance.
#pragma once

#include <set>
#include <vector>

#include "crosscheck/ball.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

struct BallLine {
  Vec3<Ball> origin, direction;
};

/// The inverse of a chain of maps, the outermost first.
class BallMap {
 public:
  explicit BallMap(std::span<const Affine3d> chain);
  [[nodiscard]] BallLine operator()(BallLine line) const;

 private:
  struct Step {
    Vec3<Ball> row_x, row_y, row_z, center;
  };
  std::vector<Step> steps_;  // identities are left out
};

struct BallCrossing {
  Ball t;
  int face;
};

/// A surface with what its crossings need again and again.
class BallSurface {
 public:
  explicit BallSurface(const Surface& surface);

  /// Ascending. Throws InDoubt where intervals cannot tell.
  [[nodiscard]] std::vector<BallCrossing> crossings(const BallLine& line) const;

 private:
  const Surface* surface_;
  std::vector<BallMap> leaf_maps_;                 // composites
  std::set<std::pair<uint32_t, uint32_t>> edges_;  // polygons
};

}  // namespace alhazen::crosscheck
