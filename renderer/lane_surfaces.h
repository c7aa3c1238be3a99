// Points on surfaces for hits side by side (renderer/surface.h).
#pragma once

#include "renderer/lane_triangles.h"

namespace alhazen {

/// `surface_point` of each, to the bit, as far as a material asks: `has` may lack what the parts have. Without
/// `has_textures`, how fast texture coordinates run is left out. Hits on meshes leave their triangles in `triangles`.
[[nodiscard]] BasicSurfacePoint<ShadingLanes> surface_points(const Scene& scene, const LaneHits& hits,
                                                             const Attributes& has, bool has_textures,
                                                             std::optional<LaneTriangles>& triangles) noexcept;

/// The same of the points that surface_points gave, to the bit; `has` and `triangles` as there.
[[nodiscard]] ShadingLanes mean_curvature(const Scene& scene, const LaneHits& hits, const Attributes& has,
                                          const BasicSurfacePoint<ShadingLanes>& points,
                                          const std::optional<LaneTriangles>& triangles,
                                          const ShadingLanes& width) noexcept;

}  // namespace alhazen
