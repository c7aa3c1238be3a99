// A scene's surfaces by the boxes around them: those that a ray may meet.
#pragma once

#include <functional>
#include <optional>

#include "accel/line_map.h"
#include "crosscheck/box_tree.h"
#include "crosscheck/scene_subjects.h"

namespace alhazen::crosscheck {

/// One surface of a scene.
struct SurfaceId {
  uint32_t object = kNone, part = 0, triangle = 0;  // as in HitWave; shapes: 0, 0
  friend bool operator==(const SurfaceId&, const SurfaceId&) = default;
};

/// Two levels: the objects in the world, and each mesh's triangles in the mesh's own space, however often it is placed.
class SceneBoxes {
 public:
  /// `geometry` must outlive it. Triangles out of reach are left out.
  explicit SceneBoxes(const Geometry& geometry);

  [[nodiscard]] const Geometry& geometry() const { return *geometry_; }
  [[nodiscard]] uint32_t object_count() const { return uint32_t(placed_.size()); }

  /// A triangle of a mesh is shown with the line in the mesh's space.
  using Visit = std::function<void(const SurfaceId&, const Triangle*, const ObjectLine<double>&)>;

  /// Shows at least every surface that the ray meets at t <= t_limit, which visiting may lower; also where sizes and
  /// maps are rounded to floats.
  void visit(const Rayf& ray_world, const double& t_limit, const Visit& visit) const;

  [[nodiscard]] Subject subject(const SurfaceId& id) const;
  [[nodiscard]] Affine3d world_from_object(uint32_t object) const;

 private:
  struct MeshBoxes {
    std::vector<uint64_t> first_triangle;  // by part, then their sum
    std::optional<BoxTree> tree;
  };

  [[nodiscard]] static MeshBoxes mesh_boxes(const Mesh& mesh);
  void visit_mesh(uint32_t object, const Rayf& ray, const double& t_limit, const Visit& visit) const;

  const Geometry* geometry_;
  std::vector<MeshBoxes> meshes_;
  struct Placed {
    LineMap<double> object_from_world;
    double margin = 0;  // in the object's space: by how much rounding its map to floats may move it
  };
  std::vector<Placed> placed_;  // by object
  std::optional<BoxTree> objects_;
};

}  // namespace alhazen::crosscheck
