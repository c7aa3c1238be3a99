// Many places of one mesh as one Embree user geometry. Embree's own instances take hundreds of bytes each; this takes
// some 30 for clusters of them and the hierarchy over these, and reads their maps where the scene has them.
#pragma once

#include "accel/embree.h"
#include "accel/geometry.h"
#include "accel/instance_clusters.h"

namespace alhazen {

/// From how many instances on this pays: below, Embree's own traverse a little faster.
inline constexpr uint32_t kLeastInstanceGroup = 1024;

/// How far rays may reach where Embree's own instance places a mesh so, at most embree::kReach; 0 where it cannot: it
/// inverts the map by cofactors and determinant in floats, and carries rays into the mesh's space whatever their size.
[[nodiscard]] float reach_around_instance(const Affine3d& world_from_object);
/// The same at every time of a track: 0 also where the map may turn singular between two poses.
[[nodiscard]] float reach_around_instance(const Track<Affine3d>& world_from_object);

/// Consecutive instances of one mesh that stand still, anywhere; or one that moves. A hit in one has the mesh's
/// geometry and primitive, and as its instance the object number with the highest bit set.
struct InstanceGroup {
  const MeshInstances* all;  // Geometry's, in place
  uint32_t first_object, count;
  RTCScene mesh;                          // committed
  const Track<Affine3d>* places;          // of the one that moves, else null
  std::vector<InstanceCluster> clusters;  // of those that stand still: the primitives
};

inline constexpr uint32_t kInGroup = 0x80000000u;

/// How many of the instances from `object` on are of the same mesh and stand still.
[[nodiscard]] uint32_t group_size(const Geometry& geometry, uint32_t object);

/// A committed user geometry over the group, which is given its clusters here and must outlive it.
[[nodiscard]] RTCGeometry new_instance_geometry(RTCDevice device, InstanceGroup& group);

}  // namespace alhazen
