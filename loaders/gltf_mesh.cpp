#include "loaders/gltf_mesh.h"

#include <algorithm>

#include "loaders/gltf_layers.h"
#include "loaders/in_parallel.h"

namespace alhazen {
namespace {

constexpr uint64_t kUnsharedCorner = 160;  // bytes, while tangents are made: without normals each becomes a vertex

/// Bytes for each vertex of a primitive: what is kept of its attributes, and what reading them takes besides.
uint64_t vertex_bytes(const JsonRef& attributes) {
  constexpr uint64_t kReading = sizeof(uint32_t) + sizeof(Vec4f);
  uint64_t bytes = sizeof(Vec3f) + kReading;
  if (attributes.has("NORMAL")) bytes += sizeof(Vec3f);
  if (attributes.has("TANGENT")) bytes += sizeof(Vec4f);
  if (attributes.has("COLOR_0")) bytes += sizeof(Vec4f);
  for (size_t i = 0; i < kMaxUvSets && attributes.has("TEXCOORD_" + std::to_string(i)); ++i) bytes += sizeof(Vec2f);
  return bytes;
}

/// A primitive that has triangles, and whose size was found to be within what the file's bytes allow.
struct Admitted {
  JsonRef r;
  size_t mesh;
};

/// Goes through the primitives in their order: what is left out, and what all of them take.
class Admission {
 public:
  Admission(GltfSource& source, const GltfBuffers& buffers, const std::vector<char>& deformable)
      : source_(source), buffers_(buffers), deformable_(deformable) {}

  std::vector<Admitted> all() {
    std::vector<Admitted> admitted;
    for (size_t i = 0; i < source_.model.meshes.size(); ++i) {
      const JsonRef primitives = source_.at("meshes", i)["primitives"];
      for (size_t k = 0; k < source_.model.meshes[i].primitives.size(); ++k) {
        const tinygltf::Primitive& in = source_.model.meshes[i].primitives[k];
        if (!admit(in, primitives[k])) continue;
        if (deformable_[i]) take_deformation(primitives[k]);
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
    const uint64_t taken_along = std::min(vertices, 2 * index + 1);
    const uint64_t triangles = in.mode == TINYGLTF_MODE_TRIANGLES ? index / 3 : index;
    const bool draco = r.extension("KHR_draco_mesh_compression").has_value();
    source_.budget->take(r, taken_along, vertex_bytes(r["attributes"]) + (draco ? kDracoVertex : 0));
    source_.budget->take(r, triangles, kTriangle + (draco ? kDracoTriangle : 0));
    source_.budget->take(r, index, sizeof(uint32_t));
    return true;
  }

  /// What morph targets and joints take besides.
  void take_deformation(const JsonRef& r) {
    for (const JsonRef& target : r.elements("targets"))
      for (const auto& attribute : target.value().items()) {
        const AccessorView& accessor = buffers_.accessor(attribute.value().get<int>());
        source_.budget->take(target, 1 + (accessor.data ? accessor.count : accessor.replaced.size()), kMorphed);
      }
    const uint64_t vertices = buffers_.accessor(r["attributes"]["POSITION"].as<int>()).count;
    source_.budget->take(r, vertices, joint_sets(r) * kJointSet);
  }

  // Bytes: the triangle itself and its share of the hierarchy; what the Draco decoder's tables take while it works.
  static constexpr uint64_t kTriangle = 160, kDracoVertex = 100, kDracoTriangle = 150;
  // A morphed vertex as it is read and kept; four joints and their weights.
  static constexpr uint64_t kMorphed = 2 * sizeof(Vec4f), kJointSet = 4 * (sizeof(uint32_t) + sizeof(float));

  GltfSource& source_;
  const GltfBuffers& buffers_;
  const std::vector<char>& deformable_;
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
  source.budget->progress.begin("meshes", admitted.size());
  for_each_in_parallel(admitted.size(), [&](size_t i) {
    const bool deforms = deformable[admitted[i].mesh];
    GltfPrimitive primitive = read_primitive(buffers, admitted[i].r, deforms);
    primitive.part.material = material_of(admitted[i].r, variant).value_or(uint32_t(materials.size() - 1));
    if (primitive.part.tangents.empty() && tangent_uv_set(materials[primitive.part.material]))
      source.budget->take(admitted[i].r, primitive.part.triangles.size(), 3 * kUnsharedCorner);
    parts[i] = deforms ? copy_of(primitive.part) : std::move(primitive.part);
    finish(parts[i], primitive.polygons, materials[parts[i].material]);
    if (deforms) primitives[i] = std::move(primitive);
    ++source.budget->progress.done;
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
