// A hit worked out: position, normals, texture coordinates, colour, material. Once, for the winner.
#pragma once

#include <array>

#include "accel/accelerated_scene.h"
#include "renderer/scene.h"

namespace alhazen {

struct SurfacePoint {
  Vec3d p_world;
  float offset = 0;          // metres along the geometric normal that clear the position's error
  Vec3f ng_world, ns_world;  // geometric and interpolated normal, unit, outward
  Vec3f tangent_world;       // unit or zero
  float bitangent_sign = 1;
  std::array<Vec2f, kMaxUvSets> uvs;
  int uv_count = 0;
  Rgba color;
  uint32_t material = 0;
  std::array<float, kMaxUvSets> uv_per_metre;  // the root of the ratio of areas; of shapes by measure_shape_uvs
  bool has_uv_per_metre = false;
  float footprint = 0;  // metres across, of what the hit stands for; 0: a point

  [[nodiscard]] SurfaceInputs inputs() const {
    return {uvs.data(), uv_count, color, footprint, has_uv_per_metre ? uv_per_metre.data() : nullptr};
  }
};

struct HitIds {
  uint32_t object, part, primitive;
};

/// What the scene signature says of a surface.
struct SurfaceIds {
  uint32_t node;       // glTF's
  uint32_t primitive;  // polygon in the node's mesh, 0 on a shape
  uint32_t material;   // glTF's; kNone for the default material
  friend bool operator==(const SurfaceIds&, const SurfaceIds&) = default;
};
[[nodiscard]] SurfaceIds surface_ids(const Scene& scene, const HitIds& hit) noexcept;

/// The surface where `ray_world` hits at t, with barycentric u and v for triangles, at that time of the shutter.
[[nodiscard]] SurfacePoint surface_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t, float u,
                                         float v, float time = 0) noexcept;

/// The mean curvature at a point that surface_point gave, per metre: half of how fast the normal turns outward as one
/// goes along the surface, summed over two perpendicular directions; below 0 in hollows. Triangles have that of their
/// vertices' normals, shapes that over `width` metres. 0 where there is none to be had.
[[nodiscard]] float mean_curvature(const Scene& scene, const HitIds& ids, const SurfacePoint& point, float width,
                                   float time = 0) noexcept;

/// Sets `uv_per_metre` of a point on a shape, from how far texture coordinates go over `width` metres. Meshes have it
/// from surface_point.
void measure_shape_uvs(const Scene& scene, const HitIds& ids, float width, float time, SurfacePoint& point) noexcept;

/// Only what texture look-ups need, for crossings met in traversal.
[[nodiscard]] SurfacePoint surface_point(const Scene& scene, const Crossing& crossing) noexcept;

/// Where a ray that leaves `point` along `direction` starts: on the exact side of the surface, further off than the
/// error of the position and of the traversal's own arithmetic.
[[nodiscard]] Vec3f spawn_origin(const SurfacePoint& point, const Vec3f& direction) noexcept;

}  // namespace alhazen
