#include "accel/reference/node_tree.h"

#include <algorithm>

namespace alhazen {
namespace {

uint32_t node_count(const Geometry& geometry, uint32_t objects) {
  auto count = uint32_t(geometry.parent_of_node.size());
  for (uint32_t object = 0; object < objects; ++object) count = std::max(count, node_of(geometry, object) + 1);
  return count;
}

}  // namespace

NodeTree::NodeTree(const Geometry& geometry, const SurfaceFilter& filter) : ReferenceAccelerator(geometry, filter) {
  const uint32_t nodes = node_count(geometry, objects_.size());
  branches_.resize(nodes + objects_.size());
  for (uint32_t node = 0; node < nodes; ++node) {
    const uint32_t parent = node < geometry.parent_of_node.size() ? geometry.parent_of_node[node] : kNone;
    (parent == kNone ? roots_ : branches_[parent].below).push_back(node);
  }
  for (uint32_t object = 0; object < objects_.size(); ++object) {
    Branch& leaf = branches_[nodes + object];
    leaf.object = object, leaf.box = objects_.bounds(object);
    branches_[node_of(geometry, object)].below.push_back(nodes + object);
  }
  // Parents before what is below them; and so, backwards, boxes are complete before they go into their parents'.
  std::vector<uint32_t> order = roots_;
  for (size_t i = 0; i < order.size(); ++i) {
    const std::vector<uint32_t>& below = branches_[order[i]].below;
    order.insert(order.end(), below.begin(), below.end());
  }
  for (auto i = order.rbegin(); i != order.rend(); ++i) finish(branches_[*i]);
}

/// What has no surface is left out, and what stands alone stands for the branch.
void NodeTree::finish(Branch& branch) {
  std::erase_if(branch.below, [&](uint32_t i) { return is_empty(branches_[i].box); });
  for (const uint32_t i : branch.below) extend(branch.box, branches_[i].box);
  if (branch.below.size() == 1) branch = Branch(branches_[branch.below.front()]);
}

void NodeTree::visit_objects(const Rayf& ray, const Visit& visit, TestCounts& counts) const {
  std::vector<uint32_t> pending = roots_;
  while (!pending.empty()) {
    const Branch& branch = branches_[pending.back()];
    pending.pop_back();
    ++counts.boxes;
    if (!may_meet(branch.box, ray)) continue;
    if (branch.object != kNone) visit(branch.object);
    pending.insert(pending.end(), branch.below.begin(), branch.below.end());
  }
}

}  // namespace alhazen
