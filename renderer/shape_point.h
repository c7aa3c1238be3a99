// Points on analytic shapes, and how the surface runs about them.
#pragma once

#include "renderer/surface.h"

namespace alhazen {

/// `surface_point` of a hit on a shape; `has_textures`: whether anybody asks for texture coordinates and tangents.
[[nodiscard]] SurfacePoint shape_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t,
                                       float time, bool has_textures);

/// `mean_curvature` of a point on a shape, which may be infinite or no number.
[[nodiscard]] float shape_curvature(const Scene& scene, const HitIds& ids, const SurfacePoint& point, float width,
                                    float time);

/// Of a shape's tangent frame, whose v runs down.
[[nodiscard]] inline float bitangent_sign(const Affine3d& m) { return determinant(m) < 0 ? 1.0f : -1.0f; }

}  // namespace alhazen
