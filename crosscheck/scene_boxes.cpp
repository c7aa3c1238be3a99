#include "crosscheck/scene_boxes.h"

#include <cmath>

namespace alhazen::crosscheck {
namespace {

constexpr uint32_t kTrianglesInLeaf = 4;
constexpr double kRounding = 0x1p-46;       // relative, of a few operations in double
constexpr double kFloatRounding = 0x1p-21;  // of a size and a map in floats

double largest(const Vec3d& v) { return max_component(abs(v)); }
double largest(const Bounds3d& b) { return std::max(largest(b.lower), largest(b.upper)); }

Bounds3d widened(const Bounds3d& b, double by) {
  return is_empty(b) ? b : Bounds3d{b.lower - Vec3d{by, by, by}, b.upper + Vec3d{by, by, by}};
}

double size_of(const Affine3d& m) { return largest(m.x) + largest(m.y) + largest(m.z); }

/// By how much roundings to floats may move what is in the box, in the world.
double float_margin(const Affine3d& m, const Bounds3d& box) {
  return is_empty(box) ? 0 : kFloatRounding * (size_of(m) * largest(box) + largest(m.origin));
}

/// As wide as the errors of the line are where it reaches the box.
WideLine wide_line(const ObjectLine<double>& line, const Bounds3d& box, double more) {
  const double reach = largest(line.origin) + largest(box);
  const double margin = more + kRounding * reach + 2 * largest(line.origin_error) +
                        2 * reach * largest(line.direction_error) / largest(line.direction);
  return {line.origin, line.direction, margin};
}

}  // namespace

SceneBoxes::SceneBoxes(const Geometry& geometry) : geometry_(&geometry) {
  for (const Mesh& mesh : geometry.meshes) meshes_.push_back(mesh_boxes(mesh));
  std::vector<Bounds3d> boxes;
  for (uint32_t object = 0; object < geometry.mesh_instances.size() + geometry.shape_instances.size(); ++object) {
    const Affine3d m = world_from_object(object);
    Bounds3d own;
    if (is_shape(geometry, object))
      own =
          std::visit([](const auto& s) { return bounds(s); }, geometry.shapes[shape_instance(geometry, object).shape]);
    else if (const auto& tree = meshes_[geometry.mesh_instances.mesh_of(object)].tree)
      own = tree->bounds();
    const double margin = float_margin(m, own);
    boxes.push_back(widened(transform_bounds(m, own), margin));
    placed_.push_back({line_map(m), m == Affine3d{} ? 0 : 3 * size_of(inverse(m)) * margin});
  }
  objects_.emplace(boxes, 1);
}

SceneBoxes::MeshBoxes SceneBoxes::mesh_boxes(const Mesh& mesh) {
  MeshBoxes out;
  std::vector<Bounds3d> boxes;
  for (const TriangleMesh& part : mesh.parts) {
    out.first_triangle.push_back(boxes.size());
    for (size_t k = 0; k < part.triangles.size(); ++k) {
      const Triangle triangle = triangle_of(part, k);
      boxes.push_back(is_reachable(triangle, {}) ? bounds(triangle) : Bounds3d{});
    }
  }
  out.first_triangle.push_back(boxes.size());
  out.tree.emplace(boxes, kTrianglesInLeaf);
  return out;
}

void SceneBoxes::visit(const Rayf& ray, const double& t_limit, const Visit& visit) const {
  const ObjectLine<double> line{Vec3d(ray.origin), Vec3d(ray.direction), {}, {}};
  objects_->visit(wide_line(line, objects_->bounds(), 0), double(ray.t_min), t_limit, [&](uint32_t object) {
    if (is_shape(*geometry_, object))
      visit({object, 0, 0}, nullptr, line);
    else
      visit_mesh(object, ray, t_limit, visit);
  });
}

void SceneBoxes::visit_mesh(uint32_t object, const Rayf& ray, const double& t_limit, const Visit& visit) const {
  const uint32_t mesh = geometry_->mesh_instances.mesh_of(object);
  const MeshBoxes& boxes = meshes_[mesh];
  const auto line = object_line(placed_[object].object_from_world, Vec3d(ray.origin), Vec3d(ray.direction));
  boxes.tree->visit(wide_line(line, boxes.tree->bounds(), placed_[object].margin), double(ray.t_min), t_limit,
                    [&](uint32_t number) {
                      uint32_t part = 0;
                      while (number >= boxes.first_triangle[part + 1]) ++part;
                      const auto k = uint32_t(number - boxes.first_triangle[part]);
                      const Triangle triangle = triangle_of(geometry_->meshes[mesh].parts[part], k);
                      visit({object, part, k}, &triangle, line);
                    });
}

Affine3d SceneBoxes::world_from_object(uint32_t object) const {
  return is_shape(*geometry_, object) ? shape_instance(*geometry_, object).world_from_object
                                      : geometry_->mesh_instances.world_from_object(object);
}

Subject SceneBoxes::subject(const SurfaceId& id) const {
  const Affine3d m = world_from_object(id.object);
  if (!is_shape(*geometry_, id.object)) {
    const Mesh& mesh = geometry_->meshes[geometry_->mesh_instances.mesh_of(id.object)];
    return {.surface = triangle_of(mesh.parts[id.part], id.triangle), .world_from_object = m};
  }
  const Shape& shape = geometry_->shapes[shape_instance(*geometry_, id.object).shape];
  return {.surface = std::visit([](const auto& s) -> Surface { return s; }, shape), .world_from_object = m};
}

}  // namespace alhazen::crosscheck
