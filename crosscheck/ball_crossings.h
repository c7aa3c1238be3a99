// Where a line crosses a surface, in interval arithmetic: the judge's first two instances.
#pragma once

#include <vector>

#include "crosscheck/ball_map.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

template <class N>
struct BallCrossing {
  Ball<N> t;
  int face;
};

/// A surface with what its crossings need again and again. N is double or DoubleDouble.
template <class N>
class BallSurface {
 public:
  /// The surface must outlive it.
  explicit BallSurface(const Surface& surface);

  /// Appends them, ascending. Throws InDoubt where intervals cannot tell.
  void append_crossings(const BallLine<N>& line, std::vector<BallCrossing<N>>& out) const;

  /// A polygon in plane coordinates.
  struct PlanePolygon {
    struct Point {
      Ball<N> x, y;
    };
    Vec3<Ball<N>> center;
    Ball<N> slope_x, slope_y, offset;
    std::vector<std::pair<Point, Point>> edges;
  };

 private:
  const Surface* surface_;
  std::vector<BallMap<N>> leaf_maps_;  // composites
  PlanePolygon polygon_;
};

}  // namespace alhazen::crosscheck
