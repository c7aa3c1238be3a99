// A hit worked out: position, normals, texture coordinates, colour, material. Once, for the winner.
#pragma once

#include <array>
#include <compare>

#include "accel/accelerated_scene.h"
#include "core/lane_vec.h"
#include "core/unset_array.h"
#include "renderer/scene.h"
#include "renderer/surface_ids.h"

namespace alhazen {

/// One surface point, or those of several lanes.
template <class F>
struct BasicSurfacePoint {
  Vec3<DoubleOf<F>> p_world;
  F offset = 0;                // metres along the geometric normal that clear the position's error
  Vec3<F> ng_world, ns_world;  // geometric and interpolated normal, unit, outward
  Vec3<F> tangent_world;       // unit or zero
  F bitangent_sign = 1;
  UnsetArray<Vec2<F>, kMaxUvSets> uvs;
  int uv_count = 0;
  BasicRgba<F> color;
  uint32_t material = 0;
  UnsetArray<F, kMaxUvSets> uv_per_metre;  // the root of the ratio of areas; of shapes by measure_shape_uvs, else 0
  F footprint = 0;                         // metres across, of what the hit stands for; 0: a point
  TextureLookup<F>* lookup = nullptr;      // see BasicSurfaceInputs

  [[nodiscard]] BasicSurfaceInputs<F> inputs() const {
    return {uvs.data(), uv_count, color, footprint, uv_per_metre.data(), lookup};
  }
};
using SurfacePoint = BasicSurfacePoint<float>;

/// The surface where `ray_world` hits at t, with barycentric u and v for triangles, at that time of the shutter.
[[nodiscard]] SurfacePoint surface_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t, float u,
                                         float v, float time = 0) noexcept;

/// What a mesh's part has beside positions.
struct Attributes {
  bool normals = false, tangents = false, colors = false;
  bool polygon_normals = false;  // in place of normals
  size_t uv_sets = 0;
  friend auto operator<=>(const Attributes&, const Attributes&) = default;
};
[[nodiscard]] inline Attributes attributes(const TriangleMesh& part) {
  return {!part.normals.empty(), !part.tangents.empty(), !part.colors.empty(),
          part.normals.empty() && !part.polygon_normals.empty(), part.uvs.size()};
}

/// The mean curvature at a point that surface_point gave, per metre: half of how fast the normal turns outward as one
/// goes along the surface, summed over two perpendicular directions; below 0 in hollows. Triangles have that of their
/// vertices' normals, shapes that over `width` metres. 0 where there is none to be had.
[[nodiscard]] float mean_curvature(const Scene& scene, const HitIds& ids, const SurfacePoint& point, float width,
                                   float time = 0) noexcept;

/// Sets `uv_per_metre` of a point on a shape, from how far texture coordinates go over `width` metres. Meshes have it
/// from surface_point.
void measure_shape_uvs(const Scene& scene, const HitIds& ids, float width, float time, SurfacePoint& point) noexcept;

/// Only what `coverage` and `straight_transmittance` ask for, of crossings met in traversal.
[[nodiscard]] SurfacePoint surface_point(const Scene& scene, const Crossing& crossing) noexcept;

/// Where a ray that leaves `point` along `direction` starts: on the exact side of the surface, further off than the
/// error of the position and of the traversal's own arithmetic.
template <class F>
[[nodiscard]] Vec3<F> spawn_origin(const BasicSurfacePoint<F>& point, const Vec3<F>& direction) noexcept {
  using D = DoubleOf<F>;
  const Vec3<F> n_f = select(dot(point.ng_world, direction) < F(0), -point.ng_world, point.ng_world);
  const Vec3<D> n = convert<D>(n_f);
  const Vec3<D> p = point.p_world + n * convert<D>(point.offset);
  const auto away = [](const D& x, const F& toward) {
    const F nearest = convert<F>(x);
    return select(toward > F(0), next_up(nearest), select(toward < F(0), F(-next_up(F(-nearest))), nearest));
  };
  return {away(p.x, n_f.x), away(p.y, n_f.y), away(p.z, n_f.z)};
}

}  // namespace alhazen
