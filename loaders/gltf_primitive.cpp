#include "loaders/gltf_primitive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "loaders/gltf_draco.h"
#include "loaders/gltf_layers.h"
#include "loaders/gltf_polygons.h"
#include "loaders/in_parallel.h"
#include "loaders/tangents.h"

namespace alhazen {
namespace {

constexpr float kMostJoints = 0x1p24f;  // as far as floats count

/// A vector to which the vertices can be appended, with the room behind them that Embree reads.
template <class T>
std::vector<T> with_room(size_t count) {
  std::vector<T> all;
  all.reserve(count + 2);
  return all;
}

/// body(first, last) for pieces of 0 to n - 1, in parallel, that fit into a processor's cache.
template <class Body>
void for_each_piece(size_t n, const Body& body) {
  constexpr size_t kPiece = 16384;
  for_each_in_parallel((n + kPiece - 1) / kPiece,
                       [&](size_t piece) { body(piece * kPiece, std::min(n, (piece + 1) * kPiece)); });
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

/// Reads one primitive; many may be read at the same time.
class PrimitiveReader {
 public:
  PrimitiveReader(const GltfBuffers& buffers, const JsonRef& r)
      : buffers_(buffers), r_(r), attributes_(r["attributes"]), mode_(r.get("mode", TINYGLTF_MODE_TRIANGLES)) {
    if (r.extension("KHR_draco_mesh_compression")) draco_ = decode_draco(r, buffers);
    vertex_count_ = attribute("POSITION").count;
  }

  GltfPrimitive read(bool deformable) {
    GltfPrimitive out{r_, {}, mode_ == TINYGLTF_MODE_TRIANGLES && r_.extension("FB_ngon_encoding"), {}, {}};
    TriangleMesh& part = out.part;
    if (const auto index = plain_index()) {
      part.triangles = read_triangles(*index);
      vertices_.resize(vertex_count_);
      std::iota(vertices_.begin(), vertices_.end(), 0u);
    } else {
      VertexChoice choice = choose_vertices(read_index(), uint32_t(vertex_count_));
      vertices_ = std::move(choice.vertices);
      part.triangles = triangles_of(draco_ ? TINYGLTF_MODE_TRIANGLES : mode_, choice.index);
    }
    part.positions = read_vec3("POSITION");
    part.normals = read_vec3("NORMAL");
    if (!part.normals.empty()) part.tangents = read_tangents();  // without normals they count for nothing
    part.colors = read_colors();
    part.uvs = read_uvs();
    if (!deformable) return out;
    for (const JsonRef& target : r_.elements("targets")) out.targets.push_back(read_target(target));
    out.skin = read_skin();
    return out;
  }

 private:
  const AccessorView& attribute(const std::string& key) const {
    if (draco_)
      if (const auto at = draco_->attributes.find(key); at != draco_->attributes.end()) return at->second;
    return buffers_.accessor(attributes_[key].as<int>());
  }

  const AccessorView& index_accessor(const JsonRef& at) const {
    const AccessorView& accessor = buffers_.accessor(at.as<int>());
    if (accessor.components != 1 || !accessor.is_unsigned_integer()) at.expected("an accessor of unsigned integers");
    return accessor;
  }

  void check_indices(const JsonRef& at, std::span<const uint32_t> index) const {
    for (const uint32_t i : index)
      if (i >= vertex_count_)
        at.fail("index " + std::to_string(i) + " out of range, POSITION has " + std::to_string(vertex_count_) +
                " vertices");
  }

  /// Where triangles' indices stand as they are wanted: of all vertices.
  std::optional<JsonRef> plain_index() const {
    const auto at = r_.find("indices");
    if (draco_ || mode_ != TINYGLTF_MODE_TRIANGLES || !at) return std::nullopt;
    const uint64_t count = index_accessor(*at).count;
    return count % 3 == 0 && count >= vertex_count_ / 2 ? at : std::nullopt;
  }

  std::vector<std::array<uint32_t, 3>> read_triangles(const JsonRef& at) const {
    const AccessorView& accessor = index_accessor(at);
    std::vector<std::array<uint32_t, 3>> triangles(accessor.count / 3);
    for_each_piece(triangles.size(), [&](size_t first, size_t last) {
      const std::span<uint32_t> corners(triangles[first].data(), 3 * (last - first));
      indices(accessor, 3 * first, corners);
      check_indices(at, corners);
    });
    return triangles;
  }

  std::vector<uint32_t> read_index() {
    if (draco_) return std::move(draco_->index);
    const auto at = r_.find("indices");
    if (!at) {
      std::vector<uint32_t> all(vertex_count_);
      std::iota(all.begin(), all.end(), 0u);
      return all;
    }
    std::vector<uint32_t> index = indices(index_accessor(*at));
    check_indices(*at, index);
    return index;
  }

  void check_shape(const JsonRef& at, const AccessorView& accessor, std::pair<size_t, size_t> components) const {
    const size_t n = accessor.components;
    if (n < components.first || n > components.second)
      at.fail("expected an accessor of " + std::to_string(components.second) + " components, it has " +
              std::to_string(n));
    if (accessor.count != vertex_count_)
      at.fail("expected an accessor of " + std::to_string(vertex_count_) + " elements as POSITION has, it has " +
              std::to_string(accessor.count));
  }

  static void check_finite(const JsonRef& at, const std::vector<float>& values) {
    if (!std::all_of(values.begin(), values.end(), [](float f) { return std::isfinite(f); }))
      at.fail("expected finite numbers, the accessor holds others");
  }

  /// The attribute's vertices made from `components` floats each; none where it is missing.
  template <class T, class Make>
  std::vector<T> read(const std::string& key, std::pair<size_t, size_t> components, Make make) {
    const auto at = attributes_.find(key);
    if (!at) return {};
    const AccessorView& accessor = attribute(key);
    check_shape(*at, accessor, components);
    auto all = with_room<T>(vertices_.size());
    all.resize(vertices_.size());
    for_each_piece(all.size(), [&](size_t first, size_t last) {
      const std::vector<float> values = floats(accessor, std::span(vertices_).subspan(first, last - first));
      check_finite(*at, values);
      const size_t n = accessor.components;
      for (size_t i = first; i < last; ++i) all[i] = make(&values[(i - first) * n], n);
    });
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

  // ---- What deforms ----

  /// The vertices, among those taken along, of which the accessor may hold something else than 0.
  std::vector<uint32_t> stored(const AccessorView& accessor) const {
    std::vector<uint32_t> all;
    if (accessor.data) {
      all.resize(vertices_.size());
      std::iota(all.begin(), all.end(), 0u);
      return all;
    }
    for (const uint32_t v : accessor.replaced) {
      const auto at = std::lower_bound(vertices_.begin(), vertices_.end(), v);
      if (at != vertices_.end() && *at == v) all.push_back(uint32_t(at - vertices_.begin()));
    }
    return all;
  }

  template <class T, class Make>
  Deltas<T> read_deltas(const JsonRef& target, const std::string& key, std::pair<size_t, size_t> components,
                        Make make) const {
    const auto at = target.find(key);
    if (!at) return {};
    const AccessorView& accessor = buffers_.accessor(at->as<int>());
    check_shape(*at, accessor, components);
    std::vector<uint32_t> rows = stored(accessor), elements;
    for (const uint32_t i : rows) elements.push_back(vertices_[i]);
    const std::vector<float> values = floats(accessor, elements);
    check_finite(*at, values);
    Deltas<T> deltas;
    for (size_t i = 0; i < rows.size(); ++i)
      if (const T delta = make(&values[i * accessor.components], accessor.components); !(delta == T{}))
        deltas.vertices.push_back(rows[i]), deltas.values.push_back(delta);
    return deltas;
  }

  MorphTarget read_target(const JsonRef& target) const {
    const auto vec2 = [](const float* v, size_t) { return Vec2f{v[0], v[1]}; };
    const auto vec3 = [](const float* v, size_t) { return Vec3f{v[0], v[1], v[2]}; };
    const auto color = [](const float* v, size_t n) { return Vec4f{v[0], v[1], v[2], n == 4 ? v[3] : 0.0f}; };
    MorphTarget out;
    out.positions = read_deltas<Vec3f>(target, "POSITION", {3, 3}, vec3);
    out.normals = read_deltas<Vec3f>(target, "NORMAL", {3, 3}, vec3);
    out.tangents = read_deltas<Vec3f>(target, "TANGENT", {3, 3}, vec3);
    out.colors = read_deltas<Vec4f>(target, "COLOR_0", {3, 4}, color);
    for (size_t i = 0; i < kMaxUvSets; ++i)
      out.uvs.push_back(read_deltas<Vec2f>(target, "TEXCOORD_" + std::to_string(i), {2, 2}, vec2));
    return out;
  }

  SkinWeights read_skin() {
    SkinWeights skin;
    const size_t sets = joint_sets(r_);
    skin.per_vertex = 4 * sets;
    skin.joints.resize(skin.per_vertex * vertices_.size());
    skin.weights.resize(skin.joints.size());
    for (size_t set = 0; set < sets; ++set) read_joint_set(set, skin);
    for (size_t first = 0; first < skin.weights.size(); first += skin.per_vertex)
      make_sum_one(std::span(skin.weights).subspan(first, skin.per_vertex));
    return skin;
  }

  void read_joint_set(size_t set, SkinWeights& skin) {
    const std::string joints_key = "JOINTS_" + std::to_string(set), weights_key = "WEIGHTS_" + std::to_string(set);
    const JsonRef at = attributes_[joints_key];
    if (!attribute(joints_key).is_unsigned_integer() || attribute(joints_key).normalized)
      at.expected("an accessor of unsigned integers");
    const auto four = [](const float* v, size_t) { return Vec4f{v[0], v[1], v[2], v[3]}; };
    const auto joints = read<Vec4f>(joints_key, {4, 4}, four), weights = read<Vec4f>(weights_key, {4, 4}, four);
    if (weights.empty() && !joints.empty()) at.fail("`" + weights_key + "` is missing");
    for (size_t i = 0; i < joints.size(); ++i) {
      const Vec4f &j = joints[i], &w = weights[i];
      if (!(w.x >= 0 && w.y >= 0 && w.z >= 0 && w.w >= 0))
        attributes_[weights_key].fail("expected weights >= 0, found others at vertex " + std::to_string(vertices_[i]));
      const size_t first = i * skin.per_vertex + 4 * set;
      for (size_t k = 0; k < 4; ++k) {
        skin.weights[first + k] = k == 0 ? w.x : k == 1 ? w.y : k == 2 ? w.z : w.w;
        skin.joints[first + k] = uint32_t(std::min(kMostJoints, k == 0 ? j.x : k == 1 ? j.y : k == 2 ? j.z : j.w));
      }
    }
  }

  /// A vertex that nothing holds follows its first joint.
  static void make_sum_one(std::span<float> weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(sum > 0)) weights[0] = 1;
    for (float& w : weights)
      if (sum > 0) w = float(double(w) / sum);
  }

  const GltfBuffers& buffers_;
  JsonRef r_, attributes_;
  int mode_;
  std::optional<DracoPrimitive> draco_;
  uint64_t vertex_count_ = 0;       // of the file
  std::vector<uint32_t> vertices_;  // those of the file's that are taken along
};

}  // namespace

GltfPrimitive read_primitive(const GltfBuffers& buffers, const JsonRef& r, bool deformable) {
  return PrimitiveReader(buffers, r).read(deformable);
}

void finish(TriangleMesh& part, bool polygons, const Material& material) {
  repair_normals(part);
  if (polygons) join_polygons(part);
  const auto uv_set = tangent_uv_set(material);
  if (part.tangents.empty() && uv_set) generate_tangents(part, *uv_set);
}

TriangleMesh copy_of(const TriangleMesh& part) {
  TriangleMesh copy = part;
  copy.positions = with_room<Vec3f>(part.positions.size());
  copy.positions.insert(copy.positions.end(), part.positions.begin(), part.positions.end());
  return copy;
}

size_t joint_sets(const JsonRef& primitive) {
  size_t sets = 0;
  while (primitive["attributes"].has("JOINTS_" + std::to_string(sets))) ++sets;
  return sets;
}

}  // namespace alhazen
