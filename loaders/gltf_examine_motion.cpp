#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "loaders/gltf_examiner.h"

namespace alhazen {
namespace {

std::vector<float> all_floats(const AccessorView& accessor) {
  std::vector<uint32_t> all(accessor.count);
  std::iota(all.begin(), all.end(), 0u);
  return floats(accessor, all);
}

// ---- Skins ----

/// Who is whose child, and the root above each.
struct Tree {
  std::vector<size_t> parent;

  explicit Tree(const JsonRef& root) {
    const auto nodes = root.elements("nodes");
    parent.resize(nodes.size());
    std::iota(parent.begin(), parent.end(), size_t{0});
    for (size_t i = 0; i < nodes.size(); ++i)
      for (const JsonRef& child : nodes[i].elements("children")) parent[child.as<size_t>()] = i;
  }
  [[nodiscard]] size_t root_of(size_t node) const {
    while (parent[node] != node) node = parent[node];
    return node;
  }
  [[nodiscard]] bool is_below(size_t node, size_t ancestor) const {
    while (node != ancestor && parent[node] != node) node = parent[node];
    return node == ancestor;
  }
};

void examine_binding(Examiner& e, const JsonRef& r, size_t joints) {
  const AccessorView& accessor = e.buffers.accessor(r.as<int>());
  e.unless(accessor.rows == 4 && accessor.components == 16 && accessor.type == TINYGLTF_COMPONENT_TYPE_FLOAT, r,
           "expected an accessor of float matrices, 4 x 4");
  e.unless(accessor.count >= joints, r,
           "has " + std::to_string(accessor.count) + " matrices for " + std::to_string(joints) + " joints");
  if (accessor.components != 16) return;
  const std::vector<float> m = all_floats(accessor);
  bool affine = true;
  for (size_t i = 0; i + 16 <= m.size(); i += 16)
    affine = affine && m[i + 3] == 0 && m[i + 7] == 0 && m[i + 11] == 0 && m[i + 15] == 1;
  e.unless(affine, r, "has matrices whose last row is not 0 0 0 1");
}

void examine_skin(Examiner& e, const JsonRef& r, const Tree& tree) {
  const Check node = index_into("/nodes");
  if (!e.unless(object({{"joints", list_of(node, 1), required},
                        {"skeleton", node},
                        {"inverseBindMatrices", index_into("/accessors")}}),
                r))
    return;
  std::vector<size_t> joints;
  for (const JsonRef& joint : r.elements("joints")) joints.push_back(joint.as<size_t>());
  const auto skeleton = r.find("skeleton");
  e.unless(
      std::all_of(joints.begin(), joints.end(), [&](size_t j) { return tree.root_of(j) == tree.root_of(joints[0]); }),
      r["joints"], "its joints have no common root");
  if (skeleton)
    e.unless(
        std::all_of(joints.begin(), joints.end(), [&](size_t j) { return tree.is_below(j, skeleton->as<size_t>()); }),
        *skeleton, "is not above all joints");
  if (const auto binding = r.find("inverseBindMatrices")) examine_binding(e, *binding, joints.size());
}

/// The roots that the default scene shows.
std::set<size_t> shown_roots(const JsonRef& root) {
  std::set<size_t> roots;
  if (root.has("scenes"))
    for (const JsonRef& r : root["scenes"][root.get("scene", size_t{0})].elements("nodes"))
      roots.insert(r.as<size_t>());
  return roots;
}

/// Where a skinned mesh is shown, its joints are.
void examine_skinned(Examiner& e, const Tree& tree) {
  const std::set<size_t> roots = shown_roots(e.root());
  const auto nodes = e.root().elements("nodes");
  for (size_t i = 0; i < nodes.size(); ++i) {
    const auto skin = nodes[i].find("skin");
    if (!skin || !e.unless(index_into("/skins"), *skin) || !roots.contains(tree.root_of(i))) continue;
    const auto& joints = e.root()["skins"][skin->as<size_t>()].value();
    if (!joints.contains("joints") || joints["joints"].empty() || !joints["joints"][0].is_number_unsigned()) continue;
    const auto joint = joints["joints"][0].get<size_t>();  // that all have one root is another matter
    e.unless(joint >= nodes.size() || roots.contains(tree.root_of(joint)), nodes[i],
             "has a skin whose joints are in no scene with it");
  }
}

// ---- Animations ----

void examine_times(Examiner& e, const JsonRef& r) {
  const JsonRef accessor = e.root()["accessors"][r.as<size_t>()];
  const AccessorView& view = e.buffers.accessor(r.as<int>());
  e.unless(accessor.has("min") && accessor.has("max"), r, "its accessor lacks min and max");
  const std::vector<float> t = all_floats(view);
  e.unless(std::all_of(t.begin(), t.end(), [](float s) { return s >= 0; }), r, "has times below 0");
  e.unless(std::adjacent_find(t.begin(), t.end(), [](float a, float b) { return !(a < b); }) == t.end(), r,
           "its times do not increase");
}

/// Input and output of one sampler, of a channel that moves `path`.
void examine_sampler(Examiner& e, const JsonRef& sampler, const std::string& path) {
  const AccessorView &in = e.buffers.accessor(sampler["input"].as<int>()),
                     &out = e.buffers.accessor(sampler["output"].as<int>());
  const bool cubic = sampler.get("interpolation", std::string("LINEAR")) == "CUBICSPLINE";
  if (e.first("times", sampler["input"].as<size_t>())) examine_times(e, sampler["input"]);
  e.unless(!cubic || in.count >= 2, sampler["input"], "has one time, cubic splines need two or more");
  for (const char* key : {"input", "output"})
    if (const auto view = e.root()["accessors"][sampler[key].as<size_t>()].find("bufferView"))
      e.unless(!e.root()["bufferViews"][view->as<size_t>()].has("byteStride"), sampler[key],
               "its buffer view has a byteStride");
  const size_t wanted = path == "rotation" ? 4 : path == "weights" ? 1 : path == "pointer" ? out.components : 3;
  e.unless(out.components == wanted, sampler["output"],
           "expected " + std::to_string(wanted) + " components for " + path);
  if (path != "weights" && path != "pointer")
    e.unless(out.count == in.count * (cubic ? 3 : 1), sampler["output"],
             "has not as many elements as its input has times");
  if (path != "rotation" || cubic || out.components != 4 || !e.first("rotations", sampler["output"].as<size_t>()))
    return;
  const std::vector<float> q = all_floats(out);
  bool unit = true;
  for (size_t i = 0; i + 4 <= q.size(); i += 4)
    unit = unit && std::abs(q[i] * q[i] + q[i + 1] * q[i + 1] + q[i + 2] * q[i + 2] + q[i + 3] * q[i + 3] - 1) < 0.02f;
  e.unless(unit, sampler["output"], "has rotations that are no unit quaternions");
}

bool has_targets(Examiner& e, size_t node) {
  const auto mesh = e.root()["nodes"][node].find("mesh");
  if (!mesh) return false;
  const auto& primitives = e.root()["meshes"][mesh->as<size_t>()]["primitives"].value();
  return !primitives.empty() && primitives[0].contains("targets");
}

void examine_animation(Examiner& e, const JsonRef& r) {
  const Check accessor = index_into("/accessors");
  const Check target = object({{"node", index_into("/nodes")}, {"path", text(), required}});
  const Check sampler =
      object({{"input", accessor, required}, {"output", accessor, required}, {"interpolation", text()}});
  if (!e.unless(object({{"samplers", list_of(sampler, 1), required}}), r)) return;
  const Check channel =
      object({{"sampler", index_into(r.pointer() + "/samplers"), required}, {"target", target, required}});
  if (!e.unless(object({{"channels", list_of(channel, 1), required}}), r)) return;
  std::set<std::pair<size_t, std::string>> moved;
  for (const JsonRef& c : r.elements("channels")) {
    const JsonRef t = c["target"];
    const auto path = t["path"].as<std::string>();
    examine_sampler(e, r["samplers"][c["sampler"].as<size_t>()], path);
    const auto node = t.find("node");
    const auto pointer = t.extension("KHR_animation_pointer");
    e.unless(!pointer || (!node && path == "pointer"), t, "KHR_animation_pointer wants the path `pointer` and no node");
    if (!node) continue;
    e.unless(moved.insert({node->as<size_t>(), path}).second, t, "another channel moves the same");
    e.unless(path != "weights" || has_targets(e, node->as<size_t>()), t,
             "moves weights of a mesh without morph targets");
  }
}

}  // namespace

void examine_motion(Examiner& e) {
  const Tree tree(e.root());
  for (const JsonRef& r : e.root().elements("skins")) examine_skin(e, r, tree);
  examine_skinned(e, tree);
  for (const JsonRef& r : e.root().elements("animations")) examine_animation(e, r);
}

}  // namespace alhazen
