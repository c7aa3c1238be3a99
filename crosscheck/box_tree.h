// A hierarchy of boxes that leaves out what a line cannot meet. The judge's own, with margins for every rounding, so
// that it relies on nothing that is judged.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ray.h"

namespace alhazen::crosscheck {

/// The points origin + t direction, give or take `margin` in each component wherever they are in the tree's box.
struct WideLine {
  Vec3d origin, direction;
  double margin = 0;
};

class BoxTree {
 public:
  /// Over boxes that are numbered as they come; empty ones are never met.
  BoxTree(std::span<const Bounds3d> boxes, uint32_t leaf_size);

  /// Around all boxes; empty where there are none.
  [[nodiscard]] Bounds3d bounds() const;

  /// Calls visit(number) at least for every box that the line meets at t_min <= t <= t_limit, nearer ones rather
  /// earlier. Visiting may lower `t_limit`.
  template <class Visit>
  void visit(const WideLine& line, double t_min, const double& t_limit, const Visit& visit) const;

 private:
  struct Node {
    Bounds3f box;
    uint32_t first = 0, count = 0;  // of its numbers; count 0: children `first` and `first` + 1
  };

  void build(uint32_t node, uint32_t first, uint32_t end, std::span<const Bounds3d> boxes, uint32_t leaf_size);

  std::vector<Node> nodes_;
  std::vector<uint32_t> numbers_;
};

/// Where the line may enter the box, infinity where it passes by. Before t_min: t_min.
[[nodiscard]] inline double entry(const Bounds3f& box, const WideLine& line, double t_min, double t_max) {
  double enter = t_min, leave = t_max;
  for (int k = 0; k < 3; ++k) {
    const double lower = double(box.lower[k]) - line.margin - line.origin[k];
    const double upper = double(box.upper[k]) + line.margin - line.origin[k];
    const double inverse = 1 / line.direction[k];
    if (line.direction[k] == 0) {
      if (lower > 0 || upper < 0) return HUGE_VAL;
      continue;
    }
    const double a = lower * inverse, b = upper * inverse;
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));  // NaN changes nothing
  }
  return enter <= leave ? enter : HUGE_VAL;
}

template <class Visit>
void BoxTree::visit(const WideLine& line, double t_min, const double& t_limit, const Visit& visit) const {
  if (nodes_.empty()) return;
  struct Pending {
    uint32_t node;
    double t;
  };
  std::vector<Pending> stack{{0, entry(nodes_[0].box, line, t_min, t_limit)}};
  while (!stack.empty()) {
    const Pending next = stack.back();
    stack.pop_back();
    if (!(next.t <= t_limit)) continue;
    const Node& node = nodes_[next.node];
    if (node.count > 0) {
      for (uint32_t k = 0; k < node.count; ++k) visit(numbers_[node.first + k]);
      continue;
    }
    Pending near{node.first, entry(nodes_[node.first].box, line, t_min, t_limit)};
    Pending far{node.first + 1, entry(nodes_[node.first + 1].box, line, t_min, t_limit)};
    if (far.t < near.t) std::swap(near, far);
    if (far.t < HUGE_VAL) stack.push_back(far);
    if (near.t < HUGE_VAL) stack.push_back(near);
  }
}

}  // namespace alhazen::crosscheck
