#include "accel/mesh_instances.h"

#include <utility>

namespace alhazen {

Affine3d world_from_object(const InstanceArray& array, size_t k) {
  Affine3f node_from_object;
  if (!array.rotations.empty() || !array.scales.empty()) {
    const Vec4f q = array.rotations.empty() ? Vec4f{0, 0, 0, 1} : array.rotations[k];
    const bool turns = q.x != 0 || q.y != 0 || q.z != 0;
    const Vec3d scale = array.scales.empty() ? Vec3d{1, 1, 1} : Vec3d(array.scales[k]);
    node_from_object = Affine3f(rotate_scale({q.x, q.y, q.z, turns ? q.w : 1}, scale));
  }
  if (!array.translations.empty()) node_from_object.origin = array.translations[k];
  return array.world_from_node * Affine3d(node_from_object);
}

void MeshInstances::append(InstanceArray array) {
  constexpr uint32_t kFew = 16;  // not worth a search at each look-up
  if (array.count >= kFew) {
    const size_t first = size();
    in_arrays_ += array.count;
    arrays_.push_back({first, alone_.size(), std::move(array)});
    return;
  }
  for (uint32_t k = 0; k < array.count; ++k)
    alone_.push_back({array.mesh, array.node, alhazen::world_from_object(array, k)});
}

}  // namespace alhazen
