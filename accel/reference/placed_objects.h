// What a ray meets of one object of the scene, found by trying each of its primitives: the ground that all reference
// accelerators stand on.
#pragma once

#include <vector>

#include "accel/geometry.h"
#include "accel/shape_hits.h"
#include "accel/surface_filter.h"
#include "core/ray.h"

namespace alhazen {

/// What finding the hits has cost.
struct TestCounts {
  uint64_t boxes = 0, primitives = 0;  // a triangle or a shape is one primitive
};

struct SurfaceHit {
  float t;  // in lengths of the ray's direction
  Crossing crossing;
};

/// A scene's objects in their places. `geometry` and the filter's data must outlive it.
class PlacedObjects {
 public:
  PlacedObjects(const Geometry& geometry, const SurfaceFilter& filter);

  [[nodiscard]] uint32_t size() const { return uint32_t(object_from_world_.size()); }

  /// A box around the object in world space, larger by a few roundings of double.
  [[nodiscard]] Bounds3d bounds(uint32_t object) const;

  /// Appends the object's hits with t_min <= t <= t_max in no order, holes left out. Which primitives are hit is
  /// decided exactly; t is rounded once.
  void append_hits(uint32_t object, const Rayf& ray_world, std::vector<SurfaceHit>& hits, TestCounts& counts) const;

  /// How much light passes the surface at a hit.
  [[nodiscard]] Rgb transmittance(const Crossing& crossing) const;

 private:
  [[nodiscard]] Affine3d world_from_object(uint32_t object) const;
  [[nodiscard]] Opacity opacity(uint32_t material) const;
  [[nodiscard]] uint32_t material_of(const Crossing& crossing) const;
  void append_if_present(const SurfaceHit& hit, std::vector<SurfaceHit>& hits) const;
  void append_shape_hits(uint32_t object, const Rayf& ray, std::vector<SurfaceHit>& hits) const;
  void append_mesh_hits(uint32_t object, const Rayf& ray, std::vector<SurfaceHit>& hits, TestCounts& counts) const;

  const Geometry& geometry_;
  SurfaceFilter filter_;
  std::vector<LineMap<double>> object_from_world_;  // by object
};

}  // namespace alhazen
