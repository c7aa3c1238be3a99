// Instances that are near each other, as one primitive of Embree's: its hierarchy takes 126 bytes for each primitive
// while it is built, which many instances are worth less than.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "accel/mesh_instances.h"
#include "core/ray.h"

namespace alhazen {

/// At most kMost instances and the boxes around them, all in world space. The boxes lie on a lattice of 256 steps over
/// the cluster's own, whose decoded corners hold what they shall (Mahovsky and Wyvill, "Memory-Conserving Bounding
/// Volume Hierarchies with Coherent Raytracing", 2006).
struct InstanceCluster {
  static constexpr uint32_t kMost = 8;
  using Lattice = std::array<std::array<uint8_t, kMost>, 3>;  // by axis and member

  Bounds3f box;
  Vec3f step;
  Lattice lower{}, upper{};
  std::array<uint32_t, kMost> objects{};
  uint32_t count = 0;

  [[nodiscard]] Bounds3f box_of(uint32_t member) const { return {corner(lower, member), corner(upper, member)}; }

 private:
  [[nodiscard]] Vec3f corner(const Lattice& at, uint32_t member) const {
    return {box.lower.x + step.x * at[0][member], box.lower.y + step.y * at[1][member],
            box.lower.z + step.z * at[2][member]};
  }
};

/// All of `first_object` ... `first_object` + `count` - 1 that traversal can meet, in full clusters but for one. Each
/// instance of a mesh within `object_box` is inside its box by the margin that a user geometry needs.
[[nodiscard]] std::vector<InstanceCluster> cluster_instances(const MeshInstances& placed, uint32_t first_object,
                                                             uint32_t count, const Bounds3d& object_box);

/// The box of an instance so placed, as a user geometry's must be; empty where traversal cannot meet it.
[[nodiscard]] Bounds3f instance_box(const Affine3d& world_from_object, const Bounds3d& object_box);

}  // namespace alhazen
