// A scene's geometry at one time of the shutter.
#pragma once

#include "accel/geometry.h"

namespace alhazen {

/// Null where the object stands still.
[[nodiscard]] inline const Track<Affine3d>* track_of_object(const Geometry& geometry, uint32_t object) {
  const auto& places = geometry.motion.places;
  return places.empty() || places[object].empty() ? nullptr : &places[object];
}

/// Null where the mesh keeps its form.
[[nodiscard]] inline const Track<MeshPose>* track_of_mesh(const Geometry& geometry, uint32_t mesh) {
  const auto& meshes = geometry.motion.meshes;
  return meshes.empty() || meshes[mesh].empty() ? nullptr : &meshes[mesh];
}

[[nodiscard]] inline Affine3d world_from_object(const Geometry& geometry, uint32_t object, float time) {
  if (const auto* track = track_of_object(geometry, object)) return at_time(*track, time);
  return is_shape(geometry, object) ? shape_instance(geometry, object).world_from_object
                                    : geometry.mesh_instances.world_from_object(object);
}

/// The deforming attributes of a mesh's part at a time, vertex by vertex.
class PosedPart {
 public:
  /// `track`: of its mesh, or null.
  PosedPart(const TriangleMesh& part, size_t part_index, const Track<MeshPose>* track, float time) : part_(part) {
    if (!track) return;
    const Moment m = moment(track->size(), time);
    before_ = &(*track)[m.before][part_index], after_ = &(*track)[m.before + 1][part_index];
    fraction_ = m.fraction;
  }

  [[nodiscard]] Vec3f position(size_t i) const {
    return before_ ? mix(before_->positions[i], after_->positions[i], fraction_) : part_.positions[i];
  }
  /// Not made unit length between two poses; as the others below.
  [[nodiscard]] Vec3f normal(size_t i) const {
    return before_ ? mix(before_->normals[i], after_->normals[i], fraction_) : part_.normals[i];
  }
  [[nodiscard]] Vec3f polygon_normal(size_t i) const {
    return before_ ? mix(before_->polygon_normals[i], after_->polygon_normals[i], fraction_) : part_.polygon_normals[i];
  }
  /// Its sign is that of the opening.
  [[nodiscard]] Vec4f tangent(size_t i) const {
    if (!before_) return part_.tangents[i];
    const Vec4f &a = before_->tangents[i], &b = after_->tangents[i];
    const Vec3f t = mix(Vec3f{a.x, a.y, a.z}, Vec3f{b.x, b.y, b.z}, fraction_);
    return {t.x, t.y, t.z, part_.tangents[i].w};
  }

 private:
  const TriangleMesh& part_;
  const PartPose *before_ = nullptr, *after_ = nullptr;
  float fraction_ = 0;
};

}  // namespace alhazen
