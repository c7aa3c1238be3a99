#include "loaders/gltf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "loaders/gltf_draco.h"
#include "loaders/gltf_layers.h"
#include "loaders/gltf_polygons.h"
#include "loaders/in_parallel.h"
#include "loaders/tangents.h"

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

/// A vector to which the vertices can be appended, with the room behind them that Embree reads.
template <class T>
std::vector<T> with_room(size_t count) {
  std::vector<T> all;
  all.reserve(count + 2);
  return all;
}

/// Which of the file's vertices a primitive takes along, and its indices into those.
struct VertexChoice {
  std::vector<uint32_t> vertices, index;
};

/// All vertices in their order; or, where most would go unused, those that are used.
VertexChoice choose_vertices(std::vector<uint32_t> index, uint32_t count) {
  VertexChoice choice;
  if (index.size() >= count / 2) {
    choice.vertices.resize(count);
    std::iota(choice.vertices.begin(), choice.vertices.end(), 0u);
    choice.index = std::move(index);
    return choice;
  }
  choice.vertices = index;
  std::sort(choice.vertices.begin(), choice.vertices.end());
  choice.vertices.erase(std::unique(choice.vertices.begin(), choice.vertices.end()), choice.vertices.end());
  for (uint32_t& i : index)
    i = uint32_t(std::lower_bound(choice.vertices.begin(), choice.vertices.end(), i) - choice.vertices.begin());
  choice.index = std::move(index);
  return choice;
}

std::vector<std::array<uint32_t, 3>> triangles_of(int mode, const std::vector<uint32_t>& index) {
  std::vector<std::array<uint32_t, 3>> triangles;
  const size_t n = index.size();
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(n / 3);
    for (size_t i = 0; i + 2 < n; i += 3) triangles.push_back({index[i], index[i + 1], index[i + 2]});
    return triangles;
  }
  // The orders that the specification's section 3.7.2.1 gives.
  for (size_t i = 0; i + 2 < n; ++i)
    triangles.push_back(mode == TINYGLTF_MODE_TRIANGLE_STRIP
                            ? std::array{index[i], index[i + 1 + i % 2], index[i + 2 - i % 2]}
                            : std::array{index[i + 1], index[i + 2], index[0]});
  return triangles;
}

Vec3f face_normal(const TriangleMesh& part, const std::array<uint32_t, 3>& t) {
  const Vec3d a(part.positions[t[0]]), b(part.positions[t[1]]), c(part.positions[t[2]]);
  return Vec3f(normalize(cross(b - a, c - a)));
}

/// Makes normals unit length; one without a direction gives way to that of a face around it.
void repair_normals(TriangleMesh& part) {
  bool lacking = false;
  for (Vec3f& n : part.normals) {
    n = Vec3f(normalize(Vec3d(n)));
    lacking |= n == Vec3f{};
  }
  if (!lacking) return;
  for (const auto& t : part.triangles)
    for (const uint32_t v : t)
      if (part.normals[v] == Vec3f{}) part.normals[v] = face_normal(part, t);
  for (Vec3f& n : part.normals)
    if (n == Vec3f{}) n = {0, 1, 0};
}

/// A primitive that has triangles, and whose size was found to be within what the file's bytes allow.
struct Admitted {
  JsonRef r;
  size_t mesh;
  int mode;
};

/// Goes through the primitives in their order: what is left out, and what all of them take.
class Admission {
 public:
  Admission(GltfSource& source, const GltfBuffers& buffers)
      : source_(source), buffers_(buffers), budget_(buffers.bytes()) {}

  std::vector<Admitted> all() {
    std::vector<Admitted> admitted;
    for (size_t i = 0; i < source_.model.meshes.size(); ++i) {
      const JsonRef primitives = source_.at("meshes", i)["primitives"];
      for (size_t k = 0; k < source_.model.meshes[i].primitives.size(); ++k) {
        const tinygltf::Primitive& in = source_.model.meshes[i].primitives[k];
        if (admit(in, primitives[k])) admitted.push_back({primitives[k], i, in.mode});
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

  /// A byte of Draco holds more than others do; each stream counts once, however many primitives share it.
  void allow_stream(int view) {
    constexpr uint64_t kElementsInByte = 12;
    if (streams_.insert(view).second) budget_.allow(kElementsInByte * buffers_.buffer_view(view).size());
  }

  GltfSource& source_;
  const GltfBuffers& buffers_;
  Budget budget_;
  std::set<int> streams_;
};

/// Reads one primitive; many may be read at the same time.
class PrimitiveReader {
 public:
  PrimitiveReader(const GltfBuffers& buffers, const Admitted& admitted)
      : buffers_(buffers), admitted_(admitted), attributes_(admitted.r["attributes"]) {
    if (admitted.r.extension("KHR_draco_mesh_compression")) draco_ = decode_draco(admitted.r, buffers);
    vertex_count_ = attribute("POSITION").count;
  }

  TriangleMesh read() {
    VertexChoice choice = choose_vertices(read_index(), uint32_t(vertex_count_));
    vertices_ = std::move(choice.vertices);
    TriangleMesh part;
    part.triangles = triangles_of(draco_ ? TINYGLTF_MODE_TRIANGLES : admitted_.mode, choice.index);
    part.positions = read_vec3("POSITION");
    part.normals = read_vec3("NORMAL");
    if (!part.normals.empty()) part.tangents = read_tangents();  // without normals they count for nothing
    part.colors = read_colors();
    part.uvs = read_uvs();
    repair_normals(part);
    if (admitted_.mode == TINYGLTF_MODE_TRIANGLES && admitted_.r.extension("FB_ngon_encoding")) join_polygons(part);
    return part;
  }

 private:
  const AccessorView& attribute(const std::string& key) const {
    if (draco_)
      if (const auto at = draco_->attributes.find(key); at != draco_->attributes.end()) return at->second;
    return buffers_.accessor(attributes_[key].as<int>());
  }

  std::vector<uint32_t> read_index() {
    if (draco_) return std::move(draco_->index);
    const auto at = admitted_.r.find("indices");
    if (!at) {
      std::vector<uint32_t> all(vertex_count_);
      std::iota(all.begin(), all.end(), 0u);
      return all;
    }
    const AccessorView& accessor = buffers_.accessor(at->as<int>());
    if (accessor.components != 1 || !accessor.is_unsigned_integer()) at->expected("an accessor of unsigned integers");
    std::vector<uint32_t> index = indices(accessor);
    for (const uint32_t i : index)
      if (i >= vertex_count_)
        at->fail("index " + std::to_string(i) + " out of range, POSITION has " + std::to_string(vertex_count_) +
                 " vertices");
    return index;
  }

  /// The attribute's vertices made from `components` floats each; none where it is missing.
  template <class T, class Make>
  std::vector<T> read(const std::string& key, std::pair<size_t, size_t> components, Make make) {
    const auto at = attributes_.find(key);
    if (!at) return {};
    const AccessorView& accessor = attribute(key);
    const size_t n = accessor.components;
    if (n < components.first || n > components.second)
      at->fail("expected an accessor of " + std::to_string(components.second) + " components, it has " +
               std::to_string(n));
    if (accessor.count != vertex_count_)
      at->fail("expected an accessor of " + std::to_string(vertex_count_) + " elements as POSITION has, it has " +
               std::to_string(accessor.count));
    const std::vector<float> values = floats(accessor, vertices_);
    if (!std::all_of(values.begin(), values.end(), [](float f) { return std::isfinite(f); }))
      at->fail("expected finite numbers, the accessor holds others");
    auto all = with_room<T>(vertices_.size());
    for (size_t i = 0; i < values.size(); i += n) all.push_back(make(&values[i], n));
    return all;
  }

  std::vector<Vec3f> read_vec3(const char* key) {
    return read<Vec3f>(key, {3, 3}, [](const float* v, size_t) { return Vec3f{v[0], v[1], v[2]}; });
  }
  std::vector<Vec4f> read_tangents() {
    return read<Vec4f>("TANGENT", {4, 4}, [](const float* v, size_t) {
      const Vec3f t(normalize(Vec3d(v[0], v[1], v[2])));
      return Vec4f{t.x, t.y, t.z, v[3] < 0 ? -1.0f : 1.0f};
    });
  }
  std::vector<Vec4f> read_colors() {
    return read<Vec4f>("COLOR_0", {3, 4}, [](const float* v, size_t n) {
      return Vec4f{v[0], v[1], v[2], n == 4 ? v[3] : 1.0f};
    });
  }
  std::vector<std::vector<Vec2f>> read_uvs() {
    std::vector<std::vector<Vec2f>> sets;
    for (size_t i = 0; i < kMaxUvSets && attributes_.has("TEXCOORD_" + std::to_string(i)); ++i)
      sets.push_back(read<Vec2f>("TEXCOORD_" + std::to_string(i), {2, 2}, [](const float* v, size_t) {
        return Vec2f{v[0], v[1]};
      }));
    return sets;
  }

  const GltfBuffers& buffers_;
  const Admitted& admitted_;
  JsonRef attributes_;
  std::optional<DracoPrimitive> draco_;
  uint64_t vertex_count_ = 0;       // of the file
  std::vector<uint32_t> vertices_;  // those of the file's that are taken along
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

void complete_tangents(std::vector<Mesh>& meshes, const std::vector<Material>& materials) {
  std::vector<TriangleMesh*> lacking;
  for (Mesh& mesh : meshes)
    for (TriangleMesh& part : mesh.parts)
      if (part.tangents.empty() && tangent_uv_set(materials[part.material])) lacking.push_back(&part);
  for_each_in_parallel(lacking.size(), [&](size_t i) {
    generate_tangents(*lacking[i], *tangent_uv_set(materials[lacking[i]->material]));
  });
}

}  // namespace

std::vector<Mesh> read_meshes(GltfSource& source, const GltfBuffers& buffers, const std::vector<Material>& materials,
                              std::optional<size_t> variant) {
  const std::vector<Admitted> admitted = Admission(source, buffers).all();
  std::vector<TriangleMesh> parts(admitted.size());
  for_each_in_parallel(admitted.size(), [&](size_t i) {
    parts[i] = PrimitiveReader(buffers, admitted[i]).read();
    parts[i].material = material_of(admitted[i].r, variant).value_or(uint32_t(materials.size() - 1));
  });
  std::vector<Mesh> meshes;
  for (const tinygltf::Mesh& in : source.model.meshes) meshes.push_back({in.name, {}});
  for (size_t i = 0; i < parts.size(); ++i) {
    std::vector<TriangleMesh>& siblings = meshes[admitted[i].mesh].parts;
    const uint64_t before =
        siblings.empty() ? 0 : siblings.back().first_primitive + uint64_t{polygon_count(siblings.back())};
    if (before + polygon_count(parts[i]) >= kNone)
      source.at("meshes", admitted[i].mesh).fail("more triangles than 32 bits can number");
    parts[i].first_primitive = uint32_t(before);
    siblings.push_back(std::move(parts[i]));
  }
  complete_tangents(meshes, materials);
  return meshes;
}

}  // namespace alhazen
