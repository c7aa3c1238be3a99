#include "loaders/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "loaders/gltf_instancing.h"

namespace alhazen {
namespace {

/// The map's position and rotation, without scale and shear: z keeps its direction, y stays as near to its own as it
/// can. None where the two do not span a plane.
std::optional<Affine3d> rigid(const Affine3d& m) {
  const Vec3d z = normalize(m.z), y = normalize(m.y - z * dot(m.y, z)), x = cross(y, z);
  if (!is_finite(x) || !(length(x) > 0.5)) return std::nullopt;
  return Affine3d{x, y, z, m.origin};
}

// ---- Cameras and lights ----

Camera read_camera(const JsonRef& r) {
  Camera camera;
  camera.name = r.get("name", std::string{});
  if (r["type"].as<std::string>() == "perspective") {
    camera.yfov = r["perspective"]["yfov"].as<double>();
  } else {
    camera.kind = Camera::Kind::orthographic;
    camera.ymag = std::abs(r["orthographic"]["ymag"].as<double>());
  }
  return camera;
}

/// KHR_lights_punctual, not placed yet.
Light read_light(const JsonRef& r) {
  Light light;
  const auto type = r["type"].as<std::string>();
  light.name = r.get("name", std::string{});
  light.kind = type == "point" ? Light::Kind::point : type == "spot" ? Light::Kind::spot : Light::Kind::directional;
  light.intensity = r.get("color", Rgb{1.0f}) * r.get("intensity", 1.0f);
  light.range = r.get("range", 0.0f);
  if (const auto spot = r.find("spot")) {
    light.cos_inner = float(std::cos(spot->get("innerConeAngle", 0.0)));
    light.cos_outer = float(std::cos(spot->get("outerConeAngle", std::numbers::pi / 4)));
    light.cos_inner = std::max(light.cos_inner, light.cos_outer);  // animated, one may overtake the other
  }
  if (const auto e = r.extension("ALHAZEN_lights"))
    light.attenuated = e->get("attenuation", std::string("inverse-square")) != "none";
  return light;
}

/// Puts into the scene what one node brings.
class Placer {
 public:
  Placer(GltfSource& source, const GltfBuffers& buffers, const PosedNodes& posed, Scene& scene)
      : source_(source), buffers_(buffers), deformations_(posed.deformations), counted_(posed.counted), scene_(scene) {
    if (const auto e = source.root().extension("KHR_lights_punctual"))
      for (const JsonRef& r : e->elements("lights")) lights_.push_back(read_light(r));
  }

  void place(uint32_t node, const Affine3d& world_from_node, bool hidden) {
    const JsonRef r = source_.at("nodes", node);
    const tinygltf::Node& in = source_.model.nodes[node];
    if (!is_finite(world_from_node)) r.fail("its global matrix overflows");
    if (in.camera >= 0) place_camera(r, uint32_t(in.camera), world_from_node);
    if (hidden) return;
    if (in.mesh >= 0) place_mesh(r, deformations_.mesh_of_node[node], node, world_from_node);
    if (const auto e = r.extension("KHR_lights_punctual"))
      place_light(r, (*e)["light"].as<uint32_t>(), world_from_node);
    if (const auto e = r.extension("ALHAZEN_shapes")) place_shape(r, *e, node, world_from_node);
  }

 private:
  void place_mesh(const JsonRef& r, uint32_t mesh, uint32_t node, const Affine3d& world_from_node) {
    if (deformations_.in_world[node]) return void(scene_.geometry.mesh_instances.push_back({mesh, node, {}}));
    if (const auto e = r.extension("EXT_mesh_gpu_instancing")) return place_instances(*e, mesh, node, world_from_node);
    if (is_invertible(world_from_node))
      scene_.geometry.mesh_instances.push_back({mesh, node, world_from_node});
    else
      source_.warn(r.pointer(), "its mesh is left out, its global matrix cannot be inverted");
  }

  void place_instances(const JsonRef& e, uint32_t mesh, uint32_t node, const Affine3d& world_from_node) {
    const uint64_t count = instance_count(e, buffers_);
    if (!counted_) source_.budget->take(e, count, kInstanceBytes);
    InstanceArray array{.mesh = mesh, .node = node, .world_from_node = world_from_node};
    read_instances(e, buffers_, array);
    const uint64_t left_out = count - array.count;
    scene_.geometry.mesh_instances.append(std::move(array));
    if (left_out > 0)
      source_.warn(e.pointer(), std::to_string(left_out) + " of its " + std::to_string(count) +
                                    " instances are left out, their matrices cannot be inverted");
  }

  void place_shape(const JsonRef& r, const JsonRef& e, uint32_t node, const Affine3d& world_from_node) {
    if (!is_invertible(world_from_node)) r.fail("places a shape by a global matrix that cannot be inverted");
    const auto default_material = uint32_t(scene_.materials.size() - 1);
    scene_.geometry.shape_instances.push_back(
        {e["shape"].as<uint32_t>(), node, e.get("material", default_material), world_from_node});
  }

  void place_camera(const JsonRef& r, uint32_t index, const Affine3d& world_from_node) {
    Camera camera = read_camera(source_.at("cameras", index));
    camera.world_from_camera = without_scale(r, world_from_node);
    scene_.cameras.push_back(std::move(camera));
    scene_.camera_index.push_back(index);
  }

  void place_light(const JsonRef& r, uint32_t index, const Affine3d& world_from_node) {
    Light light = lights_[index];
    const Affine3d world_from_light = without_scale(r, world_from_node);
    light.p_world = world_from_light.origin;
    light.direction_world = -world_from_light.z;
    scene_.lights.push_back(std::move(light));
  }

  Affine3d without_scale(const JsonRef& r, const Affine3d& world_from_node) {
    if (const auto map = rigid(world_from_node)) return *map;
    source_.warn(r.pointer(), "its camera or light keeps only its position, the global matrix has no direction");
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, world_from_node.origin};
  }

  static constexpr uint64_t kInstanceBytes = 128;  // the hierarchy over them too, while it is made

  GltfSource& source_;
  const GltfBuffers& buffers_;
  const DeformationPlan& deformations_;
  bool counted_;
  Scene& scene_;
  std::vector<Light> lights_;
};

void read_surroundings(const JsonRef& e, Scene& scene) {
  scene.has_ambient = e.has("ambient");
  scene.has_background = e.has("background");
  scene.ambient = e.get("ambient", scene.ambient);
  scene.background = e.get("background", scene.background);
}

}  // namespace

void read_scene(GltfSource& source, const GltfBuffers& buffers, const PosedNodes& nodes, Scene& scene) {
  scene.geometry.parent_of_node = nodes.forest.parent;
  const std::vector<char> hidden = hidden_nodes(source, nodes.forest);
  Placer placer(source, buffers, nodes, scene);
  for (const uint32_t node : nodes.shown) placer.place(node, nodes.world_from_node[node], hidden[node]);
  if (nodes.scene)
    if (const auto e = source.at("scenes", *nodes.scene).extension("ALHAZEN_lights")) read_surroundings(*e, scene);
}

}  // namespace alhazen
