#include "accel/geometry.h"

#include <utility>

namespace alhazen {
namespace {

void move_to_world(TriangleMesh& part, const Affine3d& world_from_object) {
  const bool mirrored = determinant(world_from_object) < 0;
  for (Vec3f& p : part.positions) p = Vec3f(transform_point(world_from_object, Vec3d(p)));
  for (Vec3f& n : part.normals) n = Vec3f(normalize(transform_normal(world_from_object, Vec3d(n))));
  for (Vec3f& n : part.polygon_normals) n = Vec3f(normalize(transform_normal(world_from_object, Vec3d(n))));
  for (Vec4f& t : part.tangents) {
    const Vec3d v = normalize(transform_vector(world_from_object, Vec3d(t.x, t.y, t.z)));
    t = {float(v.x), float(v.y), float(v.z), mirrored ? -t.w : t.w};
  }
  if (mirrored)
    for (auto& triangle : part.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace

void bake_single_instances(Geometry& geometry) {
  std::vector<uint32_t> uses(geometry.meshes.size(), 0);
  for (const MeshInstance& instance : geometry.mesh_instances) ++uses[instance.mesh];
  for (size_t i = 0; i < uses.size(); ++i)
    if (uses[i] == 0) geometry.meshes[i].parts.clear();
  for (MeshInstance& instance : geometry.mesh_instances) {
    if (uses[instance.mesh] != 1 || instance.world_from_object == Affine3d{}) continue;
    for (TriangleMesh& part : geometry.meshes[instance.mesh].parts) move_to_world(part, instance.world_from_object);
    instance.world_from_object = {};
  }
}

Bounds3d world_bounds(const Geometry& geometry) {
  Bounds3d world;
  for (const MeshInstance& instance : geometry.mesh_instances)
    for (const TriangleMesh& part : geometry.meshes[instance.mesh].parts)
      for (const auto& triangle : part.triangles)
        for (const uint32_t i : triangle) {
          const Vec3d p = transform_point(instance.world_from_object, Vec3d(part.positions[i]));
          if (is_finite(p)) extend(world, p);
        }
  for (const ShapeInstance& placed : geometry.shape_instances) {
    const Bounds3d object = std::visit([](const auto& shape) { return bounds(shape); }, geometry.shapes[placed.shape]);
    extend(world, transform_bounds(placed.world_from_object, object));
  }
  return world;
}

}  // namespace alhazen
