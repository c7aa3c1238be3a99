#include "loaders/gltf_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/fork_join.h"
#include "loaders/gltf_polygons.h"
#include "loaders/tangents.h"

namespace alhazen {
namespace {

/// Many primitives may share the few bytes of a small file, so what all of them unfold to is bounded.
class Budget {
 public:
  explicit Budget(uint64_t bytes_of_buffers) : left_((uint64_t{1} << 23) + 4 * bytes_of_buffers) {}
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

class PrimitiveReader {
 public:
  PrimitiveReader(GltfSource& source, const GltfBuffers& buffers, uint32_t default_material)
      : source_(source), buffers_(buffers), budget_(buffers.bytes()), default_material_(default_material) {}

  /// Nothing where the primitive has no triangles.
  std::optional<TriangleMesh> read(const tinygltf::Primitive& in, const JsonRef& r) {
    if (in.mode < TINYGLTF_MODE_TRIANGLES) {
      source_.warn("", "points and lines are left out");
      return std::nullopt;
    }
    if (!in.attributes.contains("POSITION")) {
      source_.warn(r.pointer(), "left out, it has no POSITION");
      return std::nullopt;
    }
    const AccessorView& position = buffers_.accessor(in.attributes.at("POSITION"));
    const VertexChoice choice = choose_vertices(read_index(in, r, uint32_t(position.count)), uint32_t(position.count));
    budget_.spend(r, choice.vertices.size());
    if (in.mode == TINYGLTF_MODE_TRIANGLES && choice.index.size() % 3)
      source_.warn(r.pointer(), "its last " + std::to_string(choice.index.size() % 3) + " vertices make no triangle");

    TriangleMesh part;
    part.material = in.material >= 0 ? uint32_t(in.material) : default_material_;
    part.triangles = triangles_of(in.mode, choice.index);
    const Attributes attributes{r["attributes"], position.count, choice.vertices};
    part.positions = read_vec3(attributes, "POSITION");
    part.normals = read_vec3(attributes, "NORMAL");
    if (!part.normals.empty()) part.tangents = read_tangents(attributes);  // without normals they count for nothing
    part.colors = read_colors(attributes);
    part.uvs = read_uvs(attributes);
    repair_normals(part);
    if (r.extension("FB_ngon_encoding")) read_polygons(in, r, part);
    return part;
  }

 private:
  void read_polygons(const tinygltf::Primitive& in, const JsonRef& r, TriangleMesh& part) {
    if (in.mode == TINYGLTF_MODE_TRIANGLES) return join_polygons(part);
    source_.warn(r.pointer(), "FB_ngon_encoding is ignored, it needs mode 4 (triangles)");
  }

  struct Attributes {
    JsonRef r;
    uint64_t count;  // of the file's vertices
    const std::vector<uint32_t>& vertices;
  };

  std::vector<uint32_t> read_index(const tinygltf::Primitive& in, const JsonRef& r, uint32_t count) {
    if (in.indices < 0) {
      budget_.spend(r, count);
      std::vector<uint32_t> all(count);
      std::iota(all.begin(), all.end(), 0u);
      return all;
    }
    const JsonRef at = r["indices"];
    const AccessorView& accessor = buffers_.accessor(in.indices);
    if (accessor.components != 1 || !accessor.is_unsigned_integer()) at.expected("an accessor of unsigned integers");
    budget_.spend(r, accessor.count);
    std::vector<uint32_t> index = indices(accessor);
    for (const uint32_t i : index)
      if (i >= count)
        at.fail("index " + std::to_string(i) + " out of range, POSITION has " + std::to_string(count) + " vertices");
    return index;
  }

  /// The attribute's vertices made from `components` floats each; none where it is missing.
  template <class T, class Make>
  std::vector<T> read(const Attributes& attributes, const std::string& key, std::pair<size_t, size_t> components,
                      Make make) {
    const auto at = attributes.r.find(key);
    if (!at) return {};
    const AccessorView& accessor = buffers_.accessor(at->as<int>());
    const size_t n = accessor.components;
    if (n < components.first || n > components.second)
      at->fail("expected an accessor of " + std::to_string(components.second) + " components, it has " +
               std::to_string(n));
    if (accessor.count != attributes.count)
      at->fail("expected an accessor of " + std::to_string(attributes.count) + " elements as POSITION has, it has " +
               std::to_string(accessor.count));
    const std::vector<float> values = floats(accessor, attributes.vertices);
    if (!std::all_of(values.begin(), values.end(), [](float f) { return std::isfinite(f); }))
      at->fail("expected finite numbers, the accessor holds others");
    auto all = with_room<T>(attributes.vertices.size());
    for (size_t i = 0; i < values.size(); i += n) all.push_back(make(&values[i], n));
    return all;
  }

  std::vector<Vec3f> read_vec3(const Attributes& attributes, const char* key) {
    return read<Vec3f>(attributes, key, {3, 3}, [](const float* v, size_t) { return Vec3f{v[0], v[1], v[2]}; });
  }
  std::vector<Vec4f> read_tangents(const Attributes& attributes) {
    return read<Vec4f>(attributes, "TANGENT", {4, 4}, [](const float* v, size_t) {
      const Vec3f t(normalize(Vec3d(v[0], v[1], v[2])));
      return Vec4f{t.x, t.y, t.z, v[3] < 0 ? -1.0f : 1.0f};
    });
  }
  std::vector<Vec4f> read_colors(const Attributes& attributes) {
    return read<Vec4f>(attributes, "COLOR_0", {3, 4}, [](const float* v, size_t n) {
      return Vec4f{v[0], v[1], v[2], n == 4 ? v[3] : 1.0f};
    });
  }
  std::vector<std::vector<Vec2f>> read_uvs(const Attributes& attributes) {
    std::vector<std::vector<Vec2f>> sets;
    for (size_t i = 0; i < kMaxUvSets && attributes.r.has("TEXCOORD_" + std::to_string(i)); ++i)
      sets.push_back(read<Vec2f>(attributes, "TEXCOORD_" + std::to_string(i), {2, 2}, [](const float* v, size_t) {
        return Vec2f{v[0], v[1]};
      }));
    return sets;
  }

  GltfSource& source_;
  const GltfBuffers& buffers_;
  Budget budget_;
  uint32_t default_material_;
};

void complete_tangents(std::vector<Mesh>& meshes, const std::vector<Material>& materials) {
  std::vector<TriangleMesh*> lacking;
  for (Mesh& mesh : meshes)
    for (TriangleMesh& part : mesh.parts)
      if (part.tangents.empty() && materials[part.material].normal_texture) lacking.push_back(&part);
  const ForkJoin order;
  tbb::parallel_for(size_t{0}, lacking.size(), order.task([&](size_t i) {
    generate_tangents(*lacking[i], materials[lacking[i]->material].normal_texture.uv_set);
  }));
}

}  // namespace

std::vector<Mesh> read_meshes(GltfSource& source, const GltfBuffers& buffers, const std::vector<Material>& materials) {
  PrimitiveReader reader(source, buffers, uint32_t(materials.size() - 1));
  std::vector<Mesh> meshes;
  for (size_t i = 0; i < source.model.meshes.size(); ++i) {
    const tinygltf::Mesh& in = source.model.meshes[i];
    const JsonRef r = source.at("meshes", i);
    Mesh mesh{in.name, {}};
    uint64_t polygons = 0;
    for (size_t k = 0; k < in.primitives.size(); ++k) {
      auto part = reader.read(in.primitives[k], r["primitives"][k]);
      if (!part) continue;
      part->first_primitive = uint32_t(polygons);
      if ((polygons += polygon_count(*part)) >= kNone) r.fail("more triangles than 32 bits can number");
      mesh.parts.push_back(std::move(*part));
    }
    meshes.push_back(std::move(mesh));
  }
  complete_tangents(meshes, materials);
  return meshes;
}

}  // namespace alhazen
