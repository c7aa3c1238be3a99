#include "loaders/deform.h"

#include <algorithm>
#include <utility>

#include "loaders/in_parallel.h"

namespace alhazen {
namespace {

constexpr size_t kAtOnce = 4096;  // vertices of a task

/// f(i) for every i < count, in parallel.
template <class F>
void for_each_vertex(size_t count, const F& f) {
  for_each_in_parallel((count + kAtOnce - 1) / kAtOnce, [&](size_t block) {
    for (size_t i = block * kAtOnce; i < std::min(count, (block + 1) * kAtOnce); ++i) f(i);
  });
}

Vec2f plus(const Vec2f& a, const Vec2f& b, float w) { return {a.x + w * b.x, a.y + w * b.y}; }
Vec3f plus(const Vec3f& a, const Vec3f& b, float w) { return {a.x + w * b.x, a.y + w * b.y, a.z + w * b.z}; }
Vec4f plus(const Vec4f& a, const Vec3f& b, float w) { return {a.x + w * b.x, a.y + w * b.y, a.z + w * b.z, a.w}; }
Vec4f plus(const Vec4f& a, const Vec4f& b, float w) {
  return {a.x + w * b.x, a.y + w * b.y, a.z + w * b.z, a.w + w * b.w};
}

template <class Attribute, class Delta>
void add(std::vector<Attribute>& attributes, const Deltas<Delta>& deltas, float weight) {
  if (attributes.empty()) return;
  for_each_vertex(deltas.vertices.size(), [&](size_t i) {
    Attribute& a = attributes[deltas.vertices[i]];
    a = plus(a, deltas.values[i], weight);
  });
}

/// The map of one vertex, which its tangent's handedness follows.
void move(TriangleMesh& part, size_t i, const Affine3d& m) {
  part.positions[i] = Vec3f(transform_point(m, Vec3d(part.positions[i])));
  if (!part.normals.empty()) part.normals[i] = Vec3f(normalize(transform_normal(m, Vec3d(part.normals[i]))));
  if (part.tangents.empty()) return;
  const Vec4f t = part.tangents[i];
  const Vec3f v(normalize(transform_vector(m, Vec3d(t.x, t.y, t.z))));
  part.tangents[i] = {v.x, v.y, v.z, determinant(m) < 0 ? -t.w : t.w};
}

Affine3d blended(const SkinWeights& weights, size_t vertex, std::span<const Affine3d> maps) {
  Affine3d sum{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (size_t k = vertex * weights.per_vertex; k < (vertex + 1) * weights.per_vertex; ++k) {
    const auto w = double(weights.weights[k]);
    if (w == 0) continue;
    const Affine3d& m = maps[weights.joints[k]];
    sum = {sum.x + m.x * w, sum.y + m.y * w, sum.z + m.z * w, sum.origin + m.origin * w};
  }
  return sum;
}

/// `map(i)` moves vertex i.
template <class MapOf>
void move_all(TriangleMesh& part, const MapOf& map) {
  std::vector<char> mirrored(part.positions.size());
  for_each_vertex(part.positions.size(), [&](size_t i) {
    const Affine3d m = map(i);
    mirrored[i] = determinant(m) < 0;
    move(part, i, m);
  });
  for (auto& t : part.triangles)
    if (mirrored[t[0]] && mirrored[t[1]] && mirrored[t[2]]) std::swap(t[1], t[2]);
}

}  // namespace

void morph(TriangleMesh& part, std::span<const MorphTarget> targets, std::span<const double> weights) {
  bool colored = false;
  for (size_t k = 0; k < targets.size(); ++k) {
    const auto w = float(weights[k]);
    if (w == 0) continue;
    const MorphTarget& target = targets[k];
    add(part.positions, target.positions, w);
    add(part.normals, target.normals, w);
    add(part.tangents, target.tangents, w);
    add(part.colors, target.colors, w);
    for (size_t set = 0; set < std::min(target.uvs.size(), part.uvs.size()); ++set)
      add(part.uvs[set], target.uvs[set], w);
    colored |= !target.colors.vertices.empty();
  }
  const auto unit = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
  if (colored)
    for (Vec4f& c : part.colors) c = {unit(c.x), unit(c.y), unit(c.z), unit(c.w)};
}

void skin(TriangleMesh& part, const SkinWeights& weights, std::span<const Affine3d> world_from_rest) {
  move_all(part, [&](size_t i) { return blended(weights, i, world_from_rest); });
}

void skin(TriangleMesh& part, const Affine3d& world_from_rest) {
  move_all(part, [&](size_t) { return world_from_rest; });
}

}  // namespace alhazen
