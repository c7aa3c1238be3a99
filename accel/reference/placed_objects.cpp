#include "accel/reference/placed_objects.h"

#include "accel/shapes/triangle.h"

namespace alhazen {
namespace {

Bounds3d bounds_of(const Mesh& mesh) {
  Bounds3d box;
  for (const TriangleMesh& part : mesh.parts)
    for (const auto& triangle : part.triangles)
      for (const uint32_t i : triangle)
        if (is_finite(Vec3d(part.positions[i]))) extend(box, Vec3d(part.positions[i]));
  return box;
}

}  // namespace

PlacedObjects::PlacedObjects(const Geometry& geometry, const SurfaceFilter& filter)
    : geometry_(geometry), filter_(filter) {
  for (const MeshInstance& instance : geometry.mesh_instances)
    object_from_world_.push_back(line_map(instance.world_from_object));
  for (const ShapeInstance& instance : geometry.shape_instances)
    object_from_world_.push_back(line_map(instance.world_from_object));
}

Affine3d PlacedObjects::world_from_object(uint32_t object) const {
  return is_shape(geometry_, object) ? shape_instance(geometry_, object).world_from_object
                                     : geometry_.mesh_instances.world_from_object(object);
}

Bounds3d PlacedObjects::bounds(uint32_t object) const {
  const Affine3d m = world_from_object(object);
  const Bounds3d box = is_shape(geometry_, object)
                           ? std::visit([](const auto& shape) { return alhazen::bounds(shape); },
                                        geometry_.shapes[shape_instance(geometry_, object).shape])
                           : bounds_of(geometry_.meshes[geometry_.mesh_instances.mesh_of(object)]);
  if (is_empty(box)) return box;
  const Bounds3d world = transform_bounds(m, box);
  const Vec3d reach = max(abs(box.lower), abs(box.upper));
  const Vec3d margin = (abs(m.x) * reach.x + abs(m.y) * reach.y + abs(m.z) * reach.z + abs(m.origin)) * 1e-14;
  return {world.lower - margin, world.upper + margin};
}

uint32_t PlacedObjects::material_of(const Crossing& crossing) const {
  if (is_shape(geometry_, crossing.object)) return shape_instance(geometry_, crossing.object).material;
  return part_of(geometry_, crossing.object, crossing.part).material;
}

Opacity PlacedObjects::opacity(uint32_t material) const {
  return filter_.opacity.empty() ? Opacity::opaque : filter_.opacity[material];
}

Rgb PlacedObjects::transmittance(const Crossing& crossing) const {
  return opacity(material_of(crossing)) == Opacity::opaque ? Rgb(0.0f) : filter_.transmittance(filter_.data, crossing);
}

void PlacedObjects::append_if_present(const SurfaceHit& hit, std::vector<SurfaceHit>& hits) const {
  const bool cutout = opacity(material_of(hit.crossing)) == Opacity::cutout;
  if (!cutout || filter_.is_present(filter_.data, hit.crossing)) hits.push_back(hit);
}

void PlacedObjects::append_shape_hits(uint32_t object, const Rayf& ray, std::vector<SurfaceHit>& hits) const {
  const ShapeInstance& instance = shape_instance(geometry_, object);
  const LineMap<double>& map = object_from_world_[object];
  thread_local std::vector<ShapeHit> found;
  found.clear();
  alhazen::append_hits({map, &instance.world_from_object, &geometry_.shapes[instance.shape]}, ray, found);
  for (const ShapeHit& hit : found)
    append_if_present({hit.t, {object, hit.face, 0, 0, 0, object_point(map, ray, hit.t)}}, hits);
}

void PlacedObjects::append_mesh_hits(uint32_t object, const Rayf& ray, std::vector<SurfaceHit>& hits,
                                     TestCounts& counts) const {
  const MeshInstance instance = geometry_.mesh_instances[object];
  const LineMap<double>& map = object_from_world_[object];
  const ObjectLine<double> line = object_line(map, Vec3d(ray.origin), Vec3d(ray.direction));
  const Mesh& mesh = geometry_.meshes[instance.mesh];
  thread_local std::vector<ShapeHit> found;
  for (uint32_t part = 0; part < mesh.parts.size(); ++part) {
    const auto& [positions, triangles] = std::tie(mesh.parts[part].positions, mesh.parts[part].triangles);
    counts.primitives += triangles.size();
    for (uint32_t i = 0; i < triangles.size(); ++i) {
      const Triangle triangle{Vec3d(positions[triangles[i][0]]), Vec3d(positions[triangles[i][1]]),
                              Vec3d(positions[triangles[i][2]])};
      const LineCrossings<double> crossing = crossings(triangle, line);
      if (!crossing.doubtful && !crossing.at[0].present) continue;  // nearly all, at the price of double
      found.clear();
      alhazen::append_hits(triangle, map, instance.world_from_object, ray, found);
      for (const ShapeHit& hit : found) {
        const Vec2d uv = weights_at(triangle, object_point(map, ray, hit.t));
        append_if_present({hit.t, {object, part, i, float(uv.x), float(uv.y), {}}}, hits);
      }
    }
  }
}

void PlacedObjects::append_hits(uint32_t object, const Rayf& ray, std::vector<SurfaceHit>& hits,
                                TestCounts& counts) const {
  if (!is_shape(geometry_, object)) return append_mesh_hits(object, ray, hits, counts);
  ++counts.primitives;
  append_shape_hits(object, ray, hits);
}

}  // namespace alhazen
