#include "renderer/surface_ids.h"

namespace alhazen {

void SurfaceIdReader::look_up(uint32_t object, uint32_t part) noexcept {
  const Geometry& geometry = scene_.geometry;
  // The default material is the last one, and none of the file's.
  const auto of_file = [&](uint32_t material) { return material + 1 == scene_.materials.size() ? kNone : material; };
  object_ = object, part_ = part;
  node_ = node_of(geometry, object);
  first_primitive_ = 0, polygon_of_triangle_ = nullptr;
  if (is_shape(geometry, object)) {
    material_ = of_file(shape_instance(geometry, object).material);
    return;
  }
  const TriangleMesh& mesh_part = part_of(geometry, object, part);
  material_ = of_file(mesh_part.material), first_primitive_ = mesh_part.first_primitive;
  if (!mesh_part.polygon_of_triangle.empty()) polygon_of_triangle_ = mesh_part.polygon_of_triangle.data();
}

SurfaceIds surface_ids(const Scene& scene, const HitIds& hit) noexcept { return SurfaceIdReader(scene)(hit); }

}  // namespace alhazen
