#include "crosscheck/box_tree.h"

#include <cmath>
#include <limits>

namespace alhazen::crosscheck {
namespace {

Bounds3f rounded_outward(const Bounds3d& b) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const auto down = [](double x) { return double(float(x)) <= x ? float(x) : std::nextafter(float(x), -inf); };
  const auto up = [](double x) { return double(float(x)) >= x ? float(x) : std::nextafter(float(x), inf); };
  return {{down(b.lower.x), down(b.lower.y), down(b.lower.z)}, {up(b.upper.x), up(b.upper.y), up(b.upper.z)}};
}

}  // namespace

BoxTree::BoxTree(std::span<const Bounds3d> boxes, uint32_t leaf_size) {
  for (uint32_t k = 0; k < boxes.size(); ++k)
    if (!is_empty(boxes[k])) numbers_.push_back(k);
  if (numbers_.empty()) return;
  nodes_.emplace_back();
  build(0, 0, uint32_t(numbers_.size()), boxes, leaf_size);
}

Bounds3d BoxTree::bounds() const {
  if (nodes_.empty()) return {};
  return {Vec3d(nodes_[0].box.lower), Vec3d(nodes_[0].box.upper)};
}

/// Halves by number, at the median of the centres along the longest side.
void BoxTree::build(uint32_t node, uint32_t first, uint32_t end, std::span<const Bounds3d> boxes, uint32_t leaf_size) {
  Bounds3d around, centers;
  const auto twice_center = [&](uint32_t k) { return boxes[k].lower + boxes[k].upper; };
  for (uint32_t k = first; k < end; ++k) extend(around, boxes[numbers_[k]]), extend(centers, twice_center(numbers_[k]));
  nodes_[node].box = rounded_outward(around);
  if (end - first <= leaf_size) {
    nodes_[node].first = first, nodes_[node].count = end - first;
    return;
  }
  const Vec3d size = centers.upper - centers.lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t middle = first + (end - first) / 2;
  std::nth_element(numbers_.begin() + first, numbers_.begin() + middle, numbers_.begin() + end,
                   [&](uint32_t a, uint32_t b) { return twice_center(a)[axis] < twice_center(b)[axis]; });
  const auto children = uint32_t(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  build(children, first, middle, boxes, leaf_size);
  build(children + 1, middle, end, boxes, leaf_size);
}

}  // namespace alhazen::crosscheck
