#include "renderer/surface.h"

#include "accel/posed.h"
#include "renderer/shape_point.h"
#include "renderer/triangle_point.h"

namespace alhazen {
namespace {

Corners<float> corners_of(const PosedPart& posed, const TriangleMesh& part, const Attributes& has, uint32_t triangle) {
  const std::array<uint32_t, 3>& corner = part.triangles[triangle];
  Corners<float> c;
  if (has.polygon_normals) c.n_polygon = posed.polygon_normal(polygon_of(part, triangle));
  for (size_t k = 0; k < 3; ++k) {
    c.p_object[k].store(posed.position(corner[k]));
    if (has.normals) c.n_object[k].store(posed.normal(corner[k]));
    if (has.tangents) {
      const Vec4f t = posed.tangent(corner[k]);
      c.t_object[k].store({t.x, t.y, t.z});
      if (k == 0) c.handedness = t.w;
    }
    for (size_t i = 0; i < has.uv_sets; ++i) c.uvs[i][k].store(part.uvs[i][corner[k]]);
    if (has.colors) {
      const Vec4f& color = part.colors[corner[k]];
      c.colors[k].store({color.x, color.y, color.z}), c.alphas[k].store(color.w);
    }
  }
  return c;
}

SurfacePoint mesh_point(const Scene& scene, const HitIds& ids, float u, float v, float time) {
  const Geometry& geometry = scene.geometry;
  const uint32_t mesh = geometry.mesh_instances.mesh_of(ids.object);
  const TriangleMesh& part = geometry.meshes[mesh].parts[ids.part];
  const PosedPart posed(part, ids.part, track_of_mesh(geometry, mesh), time);
  const Affine3d m = world_from_object(geometry, ids.object, time);
  const Affine3d* map = m == Affine3d{} ? nullptr : &m;
  const Attributes has = attributes(part);
  const Corners<float> corners = corners_of(posed, part, has, ids.primitive);
  SurfacePoint s;
  s.material = part.material;
  interpolate_attributes(corners, has, u, v, s);
  measure_uvs(corners, has, map, s);
  // Rounding of the position, of an instance's ray transform, and of the traversal's plane; of both poses in motion.
  const bool moves = track_of_object(geometry, ids.object) || track_of_mesh(geometry, mesh);
  place(corners, has, u, v, map, moves ? 64.0 : map ? 16.0 : 4.0, s);
  return s;
}

}  // namespace

SurfacePoint surface_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t, float u, float v,
                           float time) noexcept {
  if (is_shape(scene.geometry, ids.object)) return shape_point(scene, ray_world, ids, t, time, true);
  return mesh_point(scene, ids, u, v, time);
}

float mean_curvature(const Scene& scene, const HitIds& ids, const SurfacePoint& point, float width,
                     float time) noexcept {
  const Geometry& geometry = scene.geometry;
  if (is_shape(geometry, ids.object))
    return finite_or_0(ShapeCurvature(scene, ids.object, time).at(int(ids.part), point.p_world, point.ng_world, width));
  const uint32_t mesh = geometry.mesh_instances.mesh_of(ids.object);
  const TriangleMesh& part = geometry.meshes[mesh].parts[ids.part];
  if (part.normals.empty()) return 0;
  const PosedPart posed(part, ids.part, track_of_mesh(geometry, mesh), time);
  const Corners<float> corners = corners_of(posed, part, {.normals = true}, ids.primitive);
  const Affine3d m = world_from_object(geometry, ids.object, time);
  return finite_or_0(mesh_curvature(corners, m == Affine3d{} ? nullptr : &m));
}

SurfacePoint surface_point(const Scene& scene, const Crossing& crossing) noexcept {
  SurfacePoint s;
  if (is_shape(scene.geometry, crossing.object)) {
    const ShapeInstance& placed = shape_instance(scene.geometry, crossing.object);
    s.material = placed.material, s.uv_count = 1;
    const auto uv_on = [&](const auto& shape) {
      const int face = int(crossing.part);
      return texture_coordinates(shape, project(shape, crossing.p_object, face), face);
    };
    if (has_passing_textures(scene.materials[s.material]))
      s.uvs[0] = std::visit(uv_on, scene.geometry.shapes[placed.shape]);
    return s;
  }
  const TriangleMesh& part = part_of(scene.geometry, crossing.object, crossing.part);
  s.material = part.material;
  Attributes has = attributes(part);
  has.normals = has.tangents = has.polygon_normals = false;
  if (!has_passing_textures(scene.materials[s.material])) has.uv_sets = 0;
  const Corners<float> corners = corners_of(PosedPart(part, 0, nullptr, 0), part, has, crossing.primitive);
  interpolate_attributes(corners, has, crossing.u, crossing.v, s);
  return s;
}

}  // namespace alhazen