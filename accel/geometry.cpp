#include "accel/geometry.h"

#include <utility>

#include "accel/baking.h"
#include "accel/shape_bounds.h"

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

/// The vertices that triangles use; of a mesh that is placed so often that these would be too many, its box's corners.
std::vector<Vec3d> outline(const Mesh& mesh, uint64_t uses) {
  constexpr uint64_t kManyPoints = uint64_t{1} << 24;
  std::vector<Vec3d> points;
  for (const TriangleMesh& part : mesh.parts) {
    std::vector<bool> used(part.positions.size(), false);
    for (const auto& triangle : part.triangles)
      for (const uint32_t i : triangle) used[i] = true;
    for (size_t i = 0; i < used.size(); ++i)
      if (used[i]) points.emplace_back(part.positions[i]);
  }
  if (uses <= 1 || points.size() * uses <= kManyPoints) return points;
  Bounds3d box;
  for (const Vec3d& p : points) extend(box, p);
  const auto box_corners = corners(box);
  return {box_corners.begin(), box_corners.end()};
}

}  // namespace

std::vector<uint32_t> uses_of_meshes(const Geometry& geometry) {
  std::vector<uint32_t> uses(geometry.meshes.size(), 0);
  for (size_t i = 0; i < geometry.mesh_instances.size(); ++i) ++uses[geometry.mesh_instances.mesh_of(i)];
  return uses;
}

void bake_single_instances(Geometry& geometry) { bake_single_instances(geometry, {}); }

void bake_single_instances(Geometry& geometry, std::span<const char> moving) {
  const auto stays = [&](size_t mesh) { return moving.empty() || !moving[mesh]; };
  const std::vector<uint32_t> uses = uses_of_meshes(geometry);
  for (size_t i = 0; i < uses.size(); ++i)
    if (uses[i] == 0 && stays(i)) geometry.meshes[i].parts.clear();
  for (size_t i = 0; i < geometry.mesh_instances.size(); ++i) {
    const uint32_t mesh = geometry.mesh_instances.mesh_of(i);
    if (uses[mesh] != 1 || !stays(mesh)) continue;
    const Affine3d world_from_object = geometry.mesh_instances.world_from_object(i);
    if (world_from_object == Affine3d{}) continue;
    for (TriangleMesh& part : geometry.meshes[mesh].parts) move_to_world(part, world_from_object);
    geometry.mesh_instances.place(i, {});
  }
}

void visit_outline(const Geometry& geometry, const std::function<void(const Vec3d& p_world)>& visit) {
  const std::vector<uint32_t> uses = uses_of_meshes(geometry);
  std::vector<std::vector<Vec3d>> outlines(geometry.meshes.size());
  for (size_t k = 0; k < outlines.size(); ++k)
    if (uses[k] > 0) outlines[k] = outline(geometry.meshes[k], uses[k]);
  const auto visit_finite = [&](const Affine3d& world_from_object, const Vec3d& p_object) {
    if (const Vec3d p = transform_point(world_from_object, p_object); is_finite(p)) visit(p);
  };
  for (const MeshInstance& instance : geometry.mesh_instances)
    for (const Vec3d& p : outlines[instance.mesh]) visit_finite(instance.world_from_object, p);
  for (const ShapeInstance& placed : geometry.shape_instances)
    for (const Vec3d& p : corners(object_bounds(geometry.shapes[placed.shape])))
      visit_finite(placed.world_from_object, p);
}

Bounds3d world_bounds(const Geometry& geometry) {
  Bounds3d world;
  visit_outline(geometry, [&](const Vec3d& p) { extend(world, p); });
  return world;
}

}  // namespace alhazen
