#include "loaders/gltf_deformation.h"

#include <algorithm>
#include <map>

#include "loaders/in_parallel.h"

namespace alhazen {
namespace {

bool any_weight(const JsonRef& owner) {
  const auto weights = owner.get("weights", std::vector<double>{});
  return std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0; });
}

bool has_targets(const JsonRef& mesh) {
  const auto primitives = mesh.elements("primitives");
  return std::any_of(primitives.begin(), primitives.end(), [](const JsonRef& p) { return p.has("targets"); });
}

/// How the node shows its mesh; none where it does so at rest.
std::optional<Deformation> deformation_of(const GltfSource& source, const Movement& movement, uint32_t node,
                                          uint32_t mesh) {
  const JsonRef r = source.at("nodes", node), m = source.at("meshes", mesh);
  Deformation how{.mesh = mesh};
  if (const auto skin = r.find("skin")) how.skin = skin->as<uint32_t>(), how.node = node;
  if (!has_targets(m)) return how.skin == kNone ? std::nullopt : std::optional(how);
  const bool own = r.has("weights") || movement.node_weights[node];
  if (own) how.node = node;
  const bool changed = own ? movement.node_weights[node] != 0 : movement.mesh_weights[mesh] != 0;
  how.moves = changed;
  return how.skin == kNone && !changed && !any_weight(own ? r : m) ? std::nullopt : std::optional(how);
}

bool joints_move(const GltfSource& source, const Movement& movement, uint32_t skin) {
  const auto joints = source.at("skins", skin)["joints"].as<std::vector<uint32_t>>();
  return std::any_of(joints.begin(), joints.end(), [&](uint32_t joint) { return movement.nodes[joint] != 0; });
}

/// The weights that the JSON has now; as many as `count`.
std::vector<double> weights_of(const GltfSource& source, const Deformation& how, size_t count) {
  JsonRef owner = source.at("meshes", how.mesh);
  if (how.node != kNone && source.at("nodes", how.node).has("weights")) owner = source.at("nodes", how.node);
  const auto weights = owner.find("weights");
  if (!weights) return std::vector<double>(count, 0.0);
  if (weights->value().size() != count)
    weights->expected(std::to_string(count) + " numbers, one for each morph target");
  return weights->as<std::vector<double>>();
}

void check_joints(const GltfPrimitive& primitive, size_t joints, uint32_t skin) {
  const SkinWeights& s = primitive.skin;
  for (size_t i = 0; i < s.joints.size(); ++i)
    if (s.joints[i] >= joints && s.weights[i] > 0)
      primitive.r["attributes"]["JOINTS_" + std::to_string(i % s.per_vertex / 4)].fail(
          "joint " + std::to_string(s.joints[i]) + " out of range, skin " + std::to_string(skin) + " has " +
          std::to_string(joints));
}

void check_finite(const GltfPrimitive& primitive, const TriangleMesh& part) {
  if (!std::all_of(part.positions.begin(), part.positions.end(), [](const Vec3f& p) { return is_finite(p); }))
    primitive.r.fail("its vertices overflow where morph targets or joints move them");
}

}  // namespace

Movement movement(const GltfSource& source, const Forest& forest, std::span<const Channel> channels) {
  const size_t nodes = source.model.nodes.size();
  Movement m{std::vector<char>(nodes), std::vector<char>(nodes), std::vector<char>(source.model.meshes.size())};
  for (const Channel& channel : channels) {
    const PointerTokens& target = channel.target;
    if (target[0] == "nodes") (target[2] == "weights" ? m.node_weights : m.nodes)[std::stoul(target[1])] = 1;
    if (target[0] == "meshes") m.mesh_weights[std::stoul(target[1])] = 1;
    m.materials |= target[0] == "materials";
  }
  inherit(forest, m.nodes);
  return m;
}

DeformationPlan plan_deformations(const GltfSource& source, std::span<const uint32_t> shown, const Movement& movement) {
  const size_t meshes = source.model.meshes.size(), nodes = source.model.nodes.size();
  DeformationPlan plan{
      {}, std::vector<uint32_t>(nodes, kNone), std::vector<char>(nodes), std::vector<char>(meshes), meshes};
  std::vector<char> at_rest(meshes), taken(meshes);
  std::map<std::pair<uint32_t, uint32_t>, size_t> by_mesh_and_node;
  for (const uint32_t node : shown) {
    if (source.model.nodes[node].mesh < 0) continue;
    const auto mesh = uint32_t(source.model.nodes[node].mesh);
    plan.mesh_of_node[node] = mesh;
    const auto how = deformation_of(source, movement, node, mesh);
    at_rest[mesh] |= char(!how);
    if (how && by_mesh_and_node.try_emplace({mesh, how->node}, plan.all.size()).second) plan.all.push_back(*how);
  }
  for (Deformation& how : plan.all) {
    plan.deformable[how.mesh] = 1;
    if (how.skin != kNone) how.moves |= joints_move(source, movement, how.skin);
    const bool in_place = !at_rest[how.mesh] && !taken[how.mesh];
    how.placed_as = in_place ? how.mesh : uint32_t(plan.mesh_count++);
    taken[how.mesh] = 1;
  }
  for (const uint32_t node : shown) {
    if (plan.mesh_of_node[node] == kNone) continue;
    const auto how = deformation_of(source, movement, node, plan.mesh_of_node[node]);
    if (!how) continue;
    const Deformation& planned = plan.all[by_mesh_and_node.at({how->mesh, how->node})];
    plan.mesh_of_node[node] = planned.placed_as;
    plan.in_world[node] = planned.skin != kNone;
  }
  return plan;
}

void check_deformations(GltfSource& source, const std::vector<std::vector<GltfPrimitive>>& deformable,
                        std::span<const Skin> skins, const DeformationPlan& plan) {
  // Bytes of a vertex with all that it carries; of a triangle with its share of the hierarchy.
  constexpr uint64_t kVertex = 128, kTriangle = 160;
  for (const Deformation& how : plan.all) {
    for (const GltfPrimitive& primitive : deformable[how.mesh]) {
      source.budget->take(primitive.r, primitive.part.positions.size(), kVertex);
      source.budget->take(primitive.r, primitive.part.triangles.size(), kTriangle);
      if (how.skin == kNone) continue;
      if (primitive.skin.per_vertex == 0)
        source.warn(primitive.r.pointer(), "has no JOINTS_0 for its skin; it follows its node");
      check_joints(primitive, skins[how.skin].joints.size(), how.skin);
    }
    const auto& primitives = deformable[how.mesh];
    if (!primitives.empty()) (void)weights_of(source, how, primitives[0].targets.size());
  }
}

Mesh deformed(const GltfSource& source, const std::vector<GltfPrimitive>& rest, const Deformation& how,
              std::span<const Skin> skins, std::span<const Affine3d> world_from_node,
              const std::vector<Material>& materials) {
  Mesh mesh{source.model.meshes[how.mesh].name, std::vector<TriangleMesh>(rest.size())};
  if (rest.empty()) return mesh;
  const std::vector<double> weights = weights_of(source, how, rest[0].targets.size());
  std::vector<Affine3d> joints;
  if (how.skin != kNone) joints = world_from_rest(skins[how.skin], world_from_node);
  for_each_in_parallel(rest.size(), [&](size_t i) {
    TriangleMesh part = copy_of(rest[i].part);
    morph(part, rest[i].targets, weights);
    if (how.skin != kNone && rest[i].skin.per_vertex > 0) skin(part, rest[i].skin, joints);
    if (how.skin != kNone && rest[i].skin.per_vertex == 0) skin(part, world_from_node[how.node]);
    check_finite(rest[i], part);
    finish(part, rest[i].polygons, materials[part.material]);
    mesh.parts[i] = std::move(part);
  });
  return mesh;
}

}  // namespace alhazen
