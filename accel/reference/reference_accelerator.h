// The classical ways to find what a ray hits, one rung above the other: they answer what AcceleratedScene answers, and
// are simple enough to be believed. Tests compare them with it; `alhazen bench --ladder` shows what each rung saves.
#pragma once

#include <functional>

#include "accel/reference/placed_objects.h"
#include "accel/wave.h"

namespace alhazen {

/// Each way says which objects a ray may meet; the rest is the same for all, so that they answer with the same bits.
///
/// ties      the nearest hit wins; at equal distance the one with the smaller object, then part, then primitive.
///           AcceleratedScene may name another where its distances, floats found by another route, order two surfaces
///           otherwise: where surfaces coincide or cross, and on the edge that two triangles share.
class ReferenceAccelerator {
 public:
  /// `geometry` and the filter's data must outlive it.
  ReferenceAccelerator(const Geometry& geometry, const SurfaceFilter& filter) : objects_(geometry, filter) {}
  virtual ~ReferenceAccelerator() = default;

  /// The closest hit of every ray, as AcceleratedScene::intersect.
  void intersect(const RayWave& rays_world, HitWave& hits, TestCounts& counts) const;

  /// How much light passes along every segment, as AcceleratedScene::transmittance.
  void transmittance(const RayWave& rays_world, Lanes<Rgb>& visible, TestCounts& counts) const;

 protected:
  using Visit = std::function<void(uint32_t object)>;
  /// Calls `visit` for the objects that the ray may hit, each at most once. Visiting may shorten `ray`, down to
  /// nothing, for what is still to be decided.
  virtual void visit_objects(const Rayf& ray, const Visit& visit, TestCounts& counts) const = 0;

  PlacedObjects objects_;
};

/// Every primitive of every object.
class BruteForce : public ReferenceAccelerator {
 public:
  using ReferenceAccelerator::ReferenceAccelerator;

 private:
  void visit_objects(const Rayf& ray, const Visit& visit, TestCounts& counts) const override;
};

/// Whether the ray passes the box within its range; true also where it only nearly does.
[[nodiscard]] bool may_meet(const Bounds3d& box, const Rayf& ray);

}  // namespace alhazen
