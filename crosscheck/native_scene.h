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

  /// The object in floats, none where Embree cannot hold it. Of a mesh: a triangle somewhere, under its map.
  [[nodiscard]] const std::optional<NativeSubject>& subject(uint32_t object) const { return subjects_[object]; }

  /// Whether any object is another one in floats.
  [[nodiscard]] bool is_rounded() const;

  /// Whether the ray may be asked about the object: it is there, and within what its geometry is made for.
  [[nodiscard]] bool answers_for(uint32_t object, const Rayf& ray_world) const;

  /// The closest hits of all shapes.
  void answer(std::span<const Rayf> rays_world, std::vector<SceneAnswer>& answers) const;

 private:
  struct Impl;
  std::vector<std::optional<NativeSubject>> subjects_;  // by object
  std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen::crosscheck
