// A whole scene in Embree's own geometries: the second opinion on camera rays.
#pragma once

#include <memory>

#include "accel/accelerated_scene.h"
#include "crosscheck/native_subject.h"
#include "crosscheck/party.h"
#include "crosscheck/scene_boxes.h"

namespace alhazen::crosscheck {

/// What a party says of a ray through a scene.
struct SceneAnswer {
  Answer answer;
  SurfaceId id;  // where it hits
};

/// The nearer of two answers; of equally near ones the first.
[[nodiscard]] const SceneAnswer& nearer(const SceneAnswer& a, const SceneAnswer& b);

/// Shapes as the geometries of `native_party`, with the robust flag; meshes are held to be what Embree makes of them
/// under the maps that it is given, but are not in here.
class NativeScene {
 public:
  explicit NativeScene(const SceneBoxes& boxes);
  ~NativeScene();

  /// An object in floats.
  struct Object {
    Affine3d world_from_object, object_from_world;
    std::unique_ptr<Subject> shape;  // null: a mesh
  };
  /// None where Embree cannot hold it.
  [[nodiscard]] const std::optional<Object>& object(uint32_t number) const { return objects_[number]; }

  /// Whether any object is another one in floats, or none.
  [[nodiscard]] bool is_rounded() const { return rounded_; }

  /// Whether the ray may be asked about the object: it is there, and within what its geometry is made for.
  [[nodiscard]] bool answers_for(uint32_t object, const Rayf& ray_world) const;

  /// The closest hits of all shapes.
  void answer(std::span<const Rayf> rays_world, std::vector<SceneAnswer>& answers) const;

 private:
  void add_object(const SceneBoxes& boxes, uint32_t number);

  struct Impl;
  std::vector<std::optional<Object>> objects_;
  bool rounded_ = false;
  std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen::crosscheck
