#include "inspect/labels.h"

#include <array>

namespace alhazen {
namespace {

std::string name_or_index(const std::string& name, const char* kind, uint32_t index) {
  return name.empty() ? std::string(kind) + " " + std::to_string(index) : name;
}

// By the alternatives of `Shape`.
constexpr std::array kShapeNames{"sphere", "cylinder", "disk", "box", "polygon", "quadric", "composite"};
static_assert(kShapeNames.size() == std::variant_size_v<Shape>);

}  // namespace

std::string node_label(const Scene& scene, uint32_t node) {
  if (node == kNone) return "background";
  return name_or_index(node < scene.node_names.size() ? scene.node_names[node] : "", "node", node);
}

std::string material_label(const Scene& scene, uint32_t material) {
  if (material >= scene.materials.size() || material + 1 == scene.materials.size()) return "default";
  return name_or_index(scene.materials[material].name, "material", material);
}

std::string light_label(const Scene& scene, uint32_t light) {
  return name_or_index(scene.lights[light].name, "light", light);
}

std::string object_label(const Geometry& geometry, uint32_t object) {
  if (is_shape(geometry, object)) return kShapeNames[geometry.shapes[shape_instance(geometry, object).shape].index()];
  const uint32_t mesh = geometry.mesh_instances.mesh_of(object);
  const std::string& name = geometry.meshes[mesh].name;
  return name.empty() ? "mesh " + std::to_string(mesh) : "mesh " + name;
}

std::string share_text(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.2f %%", 100 * share);
  return text;
}

}  // namespace alhazen
