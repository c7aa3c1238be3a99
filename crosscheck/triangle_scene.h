// The watertight triangle (accel/shapes/triangle.h) inside Embree: a user geometry over any number of them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "accel/shapes/triangle.h"
#include "core/ray.h"
#include "core/transform.h"

namespace alhazen::crosscheck {

/// The hit of one triangle with t_min <= t <= t_max, by double, binary128 or rational numbers: whichever is sure.
[[nodiscard]] std::optional<float> hit_triangle(const Triangle& triangle, const Rayf& ray_world,
                                                const Affine3d& world_from_object = {});

/// The triangles, all placed by one map, must outlive it.
class TriangleScene {
 public:
  explicit TriangleScene(std::span<const Triangle> triangles, const Affine3d& world_from_object = {});
  ~TriangleScene();

  /// Calls found(ray, triangle, t) for each ray that hits something: the closest, of equally close ones the first.
  void trace(std::span<const Rayf> rays, const std::function<void(size_t, uint32_t, float)>& found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen::crosscheck
