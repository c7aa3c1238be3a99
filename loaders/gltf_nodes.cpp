#include "loaders/gltf_nodes.h"

#include <algorithm>
#include <array>

#include "core/transform.h"

namespace alhazen {
namespace {

Affine3d affine(const JsonRef& matrix) {
  const auto m = matrix.as<std::array<double, 16>>();
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) matrix.expected("0, 0, 0, 1 as the matrix's last row");
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

Affine3d parent_from_node(const JsonRef& node) {
  if (const auto matrix = node.find("matrix")) return affine(*matrix);
  const auto vec3 = [&](const char* key, double otherwise) {
    const auto v = node.get(key, std::array{otherwise, otherwise, otherwise});
    return Vec3d{v[0], v[1], v[2]};
  };
  const auto q = node.get("rotation", std::array{0.0, 0.0, 0.0, 1.0});
  if (q == std::array<double, 4>{}) node["rotation"].expected("a unit quaternion");
  Affine3d map = rotate_scale(q, vec3("scale", 1));
  map.origin = vec3("translation", 0);
  return map;
}

std::vector<uint32_t> roots(const Forest& forest) {
  std::vector<uint32_t> all;
  for (uint32_t i = 0; i < forest.parent.size(); ++i)
    if (forest.parent[i] == kNone) all.push_back(i);
  return all;
}

}  // namespace

std::vector<uint32_t> below(const GltfSource& source, std::vector<uint32_t> nodes) {
  for (size_t i = 0; i < nodes.size(); ++i)
    for (const int child : source.model.nodes[nodes[i]].children) nodes.push_back(uint32_t(child));
  return nodes;
}

Forest read_forest(const GltfSource& source) {
  const std::vector<tinygltf::Node>& nodes = source.model.nodes;
  Forest forest{std::vector<uint32_t>(nodes.size(), kNone), {}};
  for (uint32_t i = 0; i < nodes.size(); ++i)
    for (size_t k = 0; k < nodes[i].children.size(); ++k) {
      const auto child = size_t(nodes[i].children[k]);
      if (forest.parent[child] != kNone)
        source.at("nodes", i)["children"][k].fail("node " + std::to_string(child) + " is a child of node " +
                                                  std::to_string(forest.parent[child]) + " already");
      forest.parent[child] = i;
    }
  forest.order = below(source, roots(forest));
  // With one parent at most for each, what no root reaches lies on or under a cycle.
  std::vector<uint64_t> depth(nodes.size());
  const uint64_t deepest = source.budget->limits().node_depth;
  for (const uint32_t i : forest.order) {
    depth[i] = 1 + (forest.parent[i] == kNone ? 0 : depth[forest.parent[i]]);
    if (depth[i] > deepest)
      source.at("nodes", i)
          .fail("is nested more than " + std::to_string(deepest) + " deep; --max-node-depth raises the limit");
  }
  for (uint32_t i = 0; i < nodes.size(); ++i)
    if (depth[i] == 0) source.at("nodes", i).fail("is its own ancestor, or below one that is");
  return forest;
}

std::vector<uint32_t> scene_nodes(const GltfSource& source, const Forest& forest, std::optional<size_t> chosen) {
  if (!chosen) {
    std::vector<uint32_t> all = forest.order;
    std::sort(all.begin(), all.end());
    return all;
  }
  std::vector<uint32_t> roots;
  std::vector<char> listed(forest.parent.size());
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
  std::vector<uint32_t> shown = below(source, std::move(roots));
  std::sort(shown.begin(), shown.end());  // instances, cameras and lights come in the order of their nodes
  return shown;
}

std::vector<Affine3d> world_from_nodes(const GltfSource& source, const Forest& forest) {
  std::vector<Affine3d> world(forest.parent.size());
  for (const uint32_t i : forest.order) {
    const Affine3d local = parent_from_node(source.at("nodes", i));
    world[i] = forest.parent[i] == kNone ? local : world[forest.parent[i]] * local;
  }
  return world;
}

std::vector<char> hidden_nodes(const GltfSource& source, const Forest& forest) {
  std::vector<char> hidden(forest.parent.size());
  for (uint32_t i = 0; i < hidden.size(); ++i) {
    const JsonRef r = source.at("nodes", i);
    if (const auto e = r.extension("KHR_node_visibility")) hidden[i] |= char(!e->get("visible", true));
    if (const auto e = r.extension("MSFT_lod"))  // the node itself is the finest level
      for (const JsonRef& coarser : e->elements("ids")) hidden[coarser.as<size_t>()] = 1;
  }
  inherit(forest, hidden);
  return hidden;
}

void inherit(const Forest& forest, std::vector<char>& flags) {
  for (const uint32_t i : forest.order)
    if (forest.parent[i] != kNone) flags[i] |= flags[forest.parent[i]];
}

}  // namespace alhazen
