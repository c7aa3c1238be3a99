// Points on analytic shapes, and how the surface runs about them.
#pragma once

#include "renderer/triangle_point.h"

namespace alhazen {

/// `surface_point` of a hit on a shape; `has_textures`: whether anybody asks for texture coordinates and tangents.
[[nodiscard]] SurfacePoint shape_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t,
                                       float time, bool has_textures);

/// `mean_curvature` on one shape, hit after hit.
class ShapeCurvature {
 public:
  ShapeCurvature(const Scene& scene, uint32_t object, float time);

  /// Over `width` metres about a point on that face; may be infinite or no number.
  [[nodiscard]] float at(int face, const Vec3d& p_world, const Vec3f& ng_world, float width) const;

  /// Whether it is the same about every point, and then what it is.
  [[nodiscard]] bool is_even() const { return is_flat_ || radius_ > 0; }
  template <class F>
  [[nodiscard]] F even(const F& width) const {
    using D = DoubleOf<F>;
    if (is_flat_) return F(0);
    return convert<F>(
        D(D(1) / larger(convert<D>(width), D(radius_))));  // over more than the ball: as if it were as large
  }

 private:
  Affine3d world_from_object_;
  const Shape& shape_;
  bool is_flat_;
  double radius_;  // in the world, of a sphere that is one there; else 0
};

/// SurfacePoint::offset on a shape: the intersectors work in double on the float ray, so only the rounding of the
/// origin has to be cleared.
template <class F>
[[nodiscard]] F shape_offset(const Vec3<DoubleOf<F>>& p_world) {
  using D = DoubleOf<F>;
  const D largest = larger(absolute(p_world.x), larger(absolute(p_world.y), absolute(p_world.z)));
  return convert<F>(D(D(2 * kUlp) * largest));
}

/// Of a shape's tangent frame, whose v runs down.
[[nodiscard]] inline float bitangent_sign(const Affine3d& m) { return determinant(m) < 0 ? 1.0f : -1.0f; }

}  // namespace alhazen
