// Lines and maps in interval arithmetic.
#pragma once

#include <span>
#include <vector>

#include "core/transform.h"
#include "crosscheck/ball.h"

namespace alhazen::crosscheck {

template <class N>
struct BallLine {
  Vec3<Ball<N>> origin, direction;
};

/// The inverse of a chain of maps, the outermost first. N is double or DoubleDouble.
template <class N>
class BallMap {
 public:
  explicit BallMap(std::span<const Affine3d> chain);
  [[nodiscard]] BallLine<N> operator()(BallLine<N> line) const;

 private:
  struct Step {
    Vec3<Ball<N>> row_x, row_y, row_z, center;
  };
  std::vector<Step> steps_;  // identities are left out
};

}  // namespace alhazen::crosscheck
