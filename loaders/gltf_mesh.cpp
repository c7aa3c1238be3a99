#include "loaders/gltf_mesh.h"

#include <algorithm>
#include <set>

#include "loaders/in_parallel.h"

namespace alhazen {
namespace {

/// Many primitives may share the few bytes of a small file, so what all of them unfold to is bounded.
class Budget {
 public:
  explicit Budget(uint64_t bytes_of_buffers) : left_((uint64_t{1} << 23) + 4 * bytes_of_buffers) {}
  void allow(uint64_t elements) { left_ += elements; }
  void spend(const JsonRef& r, uint64_t elements) {
    if (elements > left_)
      r.fail("the meshes up to here share their bytes so often that they unfold to too many vertices");
    left_ -= elements;
  }

 private:
  uint64_t left_;
};

/// A primitive that has triangles, and whose size was found to be within what the file's bytes allow.
struct Admitted {
  JsonRef r;
  size_t mesh;
};

/// Goes through the primitives in their order: what is left out, and what all of them take.
class Admission {
 public:
  Admission(GltfSource& source, const GltfBuffers& buffers, const std::vector<char>& deformable)
      : source_(source), buffers_(buffers), deformable_(deformable), budget_(buffers.bytes()) {}

  std::vector<Admitted> all() {
    std::vector<Admitted> admitted;
    for (size_t i = 0; i < source_.model.meshes.size(); ++i) {
      const JsonRef primitives = source_.at("meshes", i)["primitives"];
      for (size_t k = 0; k < source_.model.meshes[i].primitives.size(); ++k) {
        const tinygltf::Primitive& in = source_.model.meshes[i].primitives[k];
        if (!admit(in, primitives[k])) continue;
        if (deformable_[i]) spend_on_deformation(primitives[k]);
        admitted.push_back({primitives[k], i});
      }
    }
    return admitted;
  }

 private:
  bool admit(const tinygltf::Primitive& in, const JsonRef& r) {
    if (in.mode < TINYGLTF_MODE_TRIANGLES) {
      source_.warn("", "points and lines are left out");
      return false;
    }
    if (!in.attributes.contains("POSITION")) {
      source_.warn(r.pointer(), "left out, it has no POSITION");
      return false;
    }
    if (in.mode != TINYGLTF_MODE_TRIANGLES && r.extension("FB_ngon_encoding"))
      source_.warn(r.pointer(), "FB_ngon_encoding is ignored, it needs mode 4 (triangles)");
    const uint64_t vertices = buffers_.accessor(in.attributes.at("POSITION")).count;
    const uint64_t index = in.indices >= 0 ? buffers_.accessor(in.indices).count : vertices;
    if (in.mode == TINYGLTF_MODE_TRIANGLES && index % 3)
      source_.warn(r.pointer(), "its last " + std::to_string(index % 3) + " vertices make no triangle");
    if (const auto draco = r.extension("KHR_draco_mesh_compression")) allow_stream((*draco)["bufferView"].as<int>());
    budget_.spend(r, index);
    budget_.spend(r, std::min(vertices, 2 * index + 1));  // no more are taken along
    return true;
  }

  /// What morph targets and joints take besides.
  void spend_on_deformation(const JsonRef& r) {
    for (const JsonRef& target : r.elements("targets"))
      for (const auto& attribute : target.value().items()) {
        const AccessorView& accessor = buffers_.accessor(attribute.value().get<int>());
        budget_.spend(target, 1 + (accessor.data ? accessor.count : accessor.replaced.size()));
      }
    const uint64_t vertices = buffers_.accessor(r["attributes"]["POSITION"].as<int>()).count;
    for (size_t set = joint_sets(r); set > 0; --set) budget_.spend(r, vertices);
  }

  /// A byte of Draco holds more than others do; each stream counts once, however many primitives share it.
  void allow_stream(int view) {
    constexpr uint64_t kElementsInByte = 12;
    if (streams_.insert(view).second) budget_.allow(kElementsInByte * buffers_.buffer_view(view).size());
  }

  GltfSource& source_;
  const GltfBuffers& buffers_;
  const std::vector<char>& deformable_;
  Budget budget_;
  std::set<int> streams_;
};

/// None: the default one.
std::optional<uint32_t> material_of(const JsonRef& primitive, std::optional<size_t> variant) {
  const auto e = primitive.extension("KHR_materials_variants");
  if (variant && e)
    for (const JsonRef& mapping : e->elements("mappings"))
      for (const JsonRef& mapped : mapping.elements("variants"))
        if (mapped.as<size_t>() == *variant) return mapping["material"].as<uint32_t>();
  if (const auto own = primitive.find("material")) return own->as<uint32_t>();
  return std::nullopt;
}

/// All primitives of a mesh have as many morph targets.
void check_targets(const std::vector<GltfPrimitive>& primitives) {
  for (const GltfPrimitive& p : primitives)
    if (p.targets.size() != primitives[0].targets.size())
      p.r.fail("expected " + std::to_string(primitives[0].targets.size()) +
               " morph targets as the mesh's first primitive has, found " + std::to_string(p.targets.size()));
}

}  // namespace

GltfMeshes read_meshes(GltfSource& source, const GltfBuffers& buffers, const std::vector<Material>& materials,
                       std::optional<size_t> variant, const std::vector<char>& deformable) {
  const std::vector<Admitted> admitted = Admission(source, buffers, deformable).all();
  std::vector<std::optional<GltfPrimitive>> primitives(admitted.size());
  std::vector<TriangleMesh> parts(admitted.size());
  for_each_in_parallel(admitted.size(), [&](size_t i) {
    const bool deforms = deformable[admitted[i].mesh];
    GltfPrimitive primitive = read_primitive(buffers, admitted[i].r, deforms);
    primitive.part.material = material_of(admitted[i].r, variant).value_or(uint32_t(materials.size() - 1));
    parts[i] = deforms ? copy_of(primitive.part) : std::move(primitive.part);
    finish(parts[i], primitive.polygons, materials[parts[i].material]);
    if (deforms) primitives[i] = std::move(primitive);
  });
  GltfMeshes all;
  all.deformable.resize(source.model.meshes.size());
  for (const tinygltf::Mesh& in : source.model.meshes) all.meshes.push_back({in.name, {}});
  for (size_t i = 0; i < parts.size(); ++i) {
    std::vector<TriangleMesh>& siblings = all.meshes[admitted[i].mesh].parts;
    const uint64_t before =
        siblings.empty() ? 0 : siblings.back().first_primitive + uint64_t{polygon_count(siblings.back())};
    if (before + polygon_count(parts[i]) >= kNone)
      source.at("meshes", admitted[i].mesh).fail("more triangles than 32 bits can number");
    parts[i].first_primitive = uint32_t(before);
    siblings.push_back(std::move(parts[i]));
    if (!primitives[i]) continue;
    primitives[i]->part.first_primitive = uint32_t(before);
    all.deformable[admitted[i].mesh].push_back(std::move(*primitives[i]));
  }
  for (const auto& siblings : all.deformable) check_targets(siblings);
  return all;
}

}  // namespace alhazen
