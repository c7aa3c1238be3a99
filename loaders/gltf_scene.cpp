#include "loaders/gltf_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "loaders/gltf_instancing.h"
#include "loaders/gltf_transform.h"

namespace alhazen {
namespace {

// ---- Maps ----

Affine3d parent_from_node(const tinygltf::Node& node, const JsonRef& r) {
  if (!node.matrix.empty()) {
    const std::vector<double>& m = node.matrix;
    const double w = m[15];
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || w != 1) r["matrix"].expected("0, 0, 0, 1 as the matrix's last row");
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  }
  const auto vec3 = [](const std::vector<double>& v, const Vec3d& otherwise) {
    return v.empty() ? otherwise : Vec3d{v[0], v[1], v[2]};
  };
  std::array<double, 4> q{0, 0, 0, 1};
  if (!node.rotation.empty()) q = {node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]};
  if (q == std::array<double, 4>{}) r["rotation"].expected("a unit quaternion");
  Affine3d map = rotate_scale(q, vec3(node.scale, {1, 1, 1}));
  map.origin = vec3(node.translation, {0, 0, 0});
  return map;
}

/// The map's position and rotation, without scale and shear: z keeps its direction, y stays as near to its own as it
/// can. None where the two do not span a plane.
std::optional<Affine3d> rigid(const Affine3d& m) {
  const Vec3d z = normalize(m.z), y = normalize(m.y - z * dot(m.y, z)), x = cross(y, z);
  if (!is_finite(x) || !(length(x) > 0.5)) return std::nullopt;
  return Affine3d{x, y, z, m.origin};
}

// ---- Cameras and lights ----

Camera read_camera(const tinygltf::Camera& in) {
  Camera camera;
  camera.name = in.name;
  if (in.type == "perspective") {
    camera.yfov = in.perspective.yfov;
  } else {
    camera.kind = Camera::Kind::orthographic;
    camera.ymag = std::abs(in.orthographic.ymag);
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
  }
  if (const auto e = r.extension("ALHAZEN_lights"))
    light.attenuated = e->get("attenuation", std::string("inverse-square")) != "none";
  return light;
}

// ---- Nodes ----

/// Who is whose child. Every node has one parent at most and none is its own ancestor.
struct Forest {
  std::vector<uint32_t> parent;  // kNone: a root
  const std::vector<tinygltf::Node>& nodes;

  /// `roots` and all below, each after its parent.
  [[nodiscard]] std::vector<uint32_t> below(const std::vector<uint32_t>& roots) const {
    std::vector<uint32_t> order = roots;
    for (size_t i = 0; i < order.size(); ++i)
      for (const int child : nodes[order[i]].children) order.push_back(uint32_t(child));
    return order;
  }
  [[nodiscard]] std::vector<uint32_t> roots() const {
    std::vector<uint32_t> all;
    for (uint32_t i = 0; i < parent.size(); ++i)
      if (parent[i] == kNone) all.push_back(i);
    return all;
  }
};

Forest read_forest(const GltfSource& source) {
  const std::vector<tinygltf::Node>& nodes = source.model.nodes;
  Forest forest{std::vector<uint32_t>(nodes.size(), kNone), nodes};
  for (uint32_t i = 0; i < nodes.size(); ++i)
    for (size_t k = 0; k < nodes[i].children.size(); ++k) {
      const auto child = size_t(nodes[i].children[k]);
      if (forest.parent[child] != kNone)
        source.at("nodes", i)["children"][k].fail("node " + std::to_string(child) + " is a child of node " +
                                                  std::to_string(forest.parent[child]) + " already");
      forest.parent[child] = i;
    }
  // With one parent at most for each, what no root reaches lies on or under a cycle.
  std::vector<char> reached(nodes.size());
  for (const uint32_t i : forest.below(forest.roots())) reached[i] = 1;
  for (uint32_t i = 0; i < nodes.size(); ++i)
    if (!reached[i]) source.at("nodes", i).fail("is its own ancestor, or below one that is");
  return forest;
}

std::vector<Affine3d> world_from_nodes(const GltfSource& source, const Forest& forest) {
  std::vector<Affine3d> world(forest.nodes.size());
  for (const uint32_t i : forest.below(forest.roots())) {
    const Affine3d local = parent_from_node(forest.nodes[i], source.at("nodes", i));
    world[i] = forest.parent[i] == kNone ? local : world[forest.parent[i]] * local;
  }
  return world;
}

/// The roots of the scene to show.
std::vector<uint32_t> shown_roots(const GltfSource& source, const Forest& forest, std::optional<size_t> chosen) {
  if (!chosen) return forest.roots();
  std::vector<uint32_t> roots;
  std::vector<char> listed(forest.nodes.size());
  const std::vector<int>& nodes = source.model.scenes[*chosen].nodes;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const auto n = uint32_t(nodes[i]);
    const auto fail = [&](const char* why) {
      source.at("scenes", *chosen)["nodes"][i].fail("node " + std::to_string(n) + why);
    };
    if (forest.parent[n] != kNone) fail(" is no root but a child of another node");
    if (listed[n]) fail(" is listed twice");
    listed[n] = 1;
    roots.push_back(n);
  }
  return roots;
}

/// Which nodes are not seen, by themselves or below one that is not.
std::vector<char> hidden_nodes(const GltfSource& source, const Forest& forest) {
  std::vector<char> hidden(forest.nodes.size());
  for (uint32_t i = 0; i < hidden.size(); ++i) {
    const JsonRef r = source.at("nodes", i);
    if (const auto e = r.extension("KHR_node_visibility")) hidden[i] |= char(!e->get("visible", true));
    if (const auto e = r.extension("MSFT_lod"))  // the node itself is the finest level
      for (const JsonRef& coarser : e->elements("ids")) hidden[coarser.as<size_t>()] = 1;
  }
  for (const uint32_t i : forest.below(forest.roots()))
    if (forest.parent[i] != kNone) hidden[i] |= hidden[forest.parent[i]];
  return hidden;
}

/// Puts into the scene what one node brings.
class Placer {
 public:
  Placer(GltfSource& source, const GltfBuffers& buffers, Scene& scene)
      : source_(source), buffers_(buffers), scene_(scene), instances_left_(kMostInstances + buffers.bytes() / 8) {
    if (const auto e = source.root().extension("KHR_lights_punctual"))
      for (const JsonRef& r : e->elements("lights")) lights_.push_back(read_light(r));
  }

  void place(uint32_t node, const Affine3d& world_from_node, bool hidden) {
    const JsonRef r = source_.at("nodes", node);
    const tinygltf::Node& in = source_.model.nodes[node];
    if (!is_finite(world_from_node)) r.fail("its global matrix overflows");
    if (in.camera >= 0) place_camera(r, uint32_t(in.camera), world_from_node);
    if (hidden) return;
    if (in.mesh >= 0) place_mesh(r, uint32_t(in.mesh), node, world_from_node);
    if (const auto e = r.extension("KHR_lights_punctual"))
      place_light(r, (*e)["light"].as<uint32_t>(), world_from_node);
    if (const auto e = r.extension("ALHAZEN_shapes")) place_shape(r, *e, node, world_from_node);
  }

 private:
  void place_mesh(const JsonRef& r, uint32_t mesh, uint32_t node, const Affine3d& world_from_node) {
    if (const auto e = r.extension("EXT_mesh_gpu_instancing")) return place_instances(*e, mesh, node, world_from_node);
    if (is_invertible(world_from_node))
      scene_.geometry.mesh_instances.push_back({mesh, node, world_from_node});
    else
      source_.warn(r.pointer(), "its mesh is left out, its global matrix cannot be inverted");
  }

  /// Nodes may share the few bytes of a small file, so what all of them unfold to is bounded.
  void place_instances(const JsonRef& e, uint32_t mesh, uint32_t node, const Affine3d& world_from_node) {
    const uint64_t count = instance_count(e, buffers_);
    if (count > instances_left_)
      e.fail("the instances up to here share their bytes so often that they unfold to too many");
    instances_left_ -= count;
    std::vector<MeshInstance>& placed = scene_.geometry.mesh_instances;
    placed.reserve(placed.size() + count);
    uint64_t left_out = 0;
    constexpr uint64_t kAtOnce = 4096;  // their numbers take little besides the instances themselves
    for (uint64_t first = 0; first < count; first += kAtOnce)
      for (const Affine3f& m : read_instances(e, buffers_, first, std::min(kAtOnce, count - first))) {
        const Affine3d map = world_from_node * Affine3d(m);
        if (is_invertible(map))
          placed.push_back({mesh, node, map});
        else
          ++left_out;
      }
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
    Camera camera = read_camera(source_.model.cameras[index]);
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

  static constexpr uint64_t kMostInstances = 1 << 16;  // besides those that have bytes of their own

  GltfSource& source_;
  const GltfBuffers& buffers_;
  Scene& scene_;
  uint64_t instances_left_;
  std::vector<Light> lights_;
};

void read_surroundings(const JsonRef& e, Scene& scene) {
  scene.has_ambient = e.has("ambient");
  scene.has_background = e.has("background");
  scene.ambient = e.get("ambient", scene.ambient);
  scene.background = e.get("background", scene.background);
}

}  // namespace

void read_scene(GltfSource& source, const GltfBuffers& buffers, std::optional<size_t> chosen, Scene& scene) {
  for (const tinygltf::Node& node : source.model.nodes) scene.node_names.push_back(node.name);
  const Forest forest = read_forest(source);
  scene.geometry.parent_of_node = forest.parent;
  const std::vector<Affine3d> world = world_from_nodes(source, forest);
  const std::vector<char> hidden = hidden_nodes(source, forest);
  std::vector<uint32_t> shown = forest.below(shown_roots(source, forest, chosen));
  std::sort(shown.begin(), shown.end());  // instances, cameras and lights come in the order of their nodes
  Placer placer(source, buffers, scene);
  for (const uint32_t node : shown) placer.place(node, world[node], hidden[node]);
  if (chosen)
    if (const auto e = source.at("scenes", *chosen).extension("ALHAZEN_lights")) read_surroundings(*e, scene);
}

}  // namespace alhazen
