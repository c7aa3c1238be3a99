// The third rung: the scene's own hierarchy of nodes, a box around each node and all below it.
#pragma once

#include "accel/reference/reference_accelerator.h"

namespace alhazen {

/// Leaves out whole branches of the scene's nodes. How much that saves is the modeller's doing: nodes that are all
/// roots make no hierarchy.
class NodeTree : public ReferenceAccelerator {
 public:
  NodeTree(const Geometry& geometry, const SurfaceFilter& filter);

 private:
  struct Branch {
    Bounds3d box;  // around everything below, world space
    std::vector<uint32_t> below;
    uint32_t object = kNone;  // of a leaf
  };

  void finish(Branch& branch);
  void visit_objects(const Rayf& ray, const Visit& visit, TestCounts& counts) const override;

  std::vector<Branch> branches_;  // the nodes, then the objects
  std::vector<uint32_t> roots_;
};

}  // namespace alhazen
