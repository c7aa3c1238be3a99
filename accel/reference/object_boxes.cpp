#include "accel/reference/object_boxes.h"

namespace alhazen {

ObjectBoxes::ObjectBoxes(const Geometry& geometry, const SurfaceFilter& filter)
    : ReferenceAccelerator(geometry, filter) {
  for (uint32_t object = 0; object < objects_.size(); ++object) boxes_.push_back(objects_.bounds(object));
}

void ObjectBoxes::visit_objects(const Rayf& ray, const Visit& visit, TestCounts& counts) const {
  counts.boxes += boxes_.size();
  for (uint32_t object = 0; object < boxes_.size(); ++object)
    if (may_meet(boxes_[object], ray)) visit(object);
}

}  // namespace alhazen
