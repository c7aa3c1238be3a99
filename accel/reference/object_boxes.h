// The second rung: a bounding box around each object.
#pragma once

#include "accel/reference/reference_accelerator.h"

namespace alhazen {

/// Tries the objects whose boxes the ray meets.
class ObjectBoxes : public ReferenceAccelerator {
 public:
  ObjectBoxes(const Geometry& geometry, const SurfaceFilter& filter);

 protected:
  void visit_objects(const Rayf& ray, const Visit& visit, TestCounts& counts) const override;

  std::vector<Bounds3d> boxes_;  // by object, world space
};

}  // namespace alhazen
