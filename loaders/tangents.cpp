#include "loaders/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <vector>

namespace alhazen {
namespace {

constexpr uint32_t kUnset = std::numeric_limits<uint32_t>::max();

/// Which way UVs turn on a triangle: as its corners do, or mirrored.
enum Turn : uint8_t { kUpright, kMirrored, kNoTurn };

template <class T>
void gather(std::vector<T>& all, const std::vector<uint32_t>& from) {
  if (all.empty()) return;
  std::vector<T> out;
  out.reserve(from.size() + 2);  // Embree reads 16 bytes for each vertex
  for (const uint32_t v : from) out.push_back(all[v]);
  all = std::move(out);
}

/// New vertex i is what vertex from[i] was, in all attributes but tangents.
void gather_vertices(TriangleMesh& mesh, const std::vector<uint32_t>& from) {
  gather(mesh.positions, from);
  gather(mesh.normals, from);
  gather(mesh.colors, from);
  for (auto& uv : mesh.uvs) gather(uv, from);
}

void make_flat_normals(TriangleMesh& mesh) {
  std::vector<uint32_t> from;
  from.reserve(mesh.triangles.size() * 3);
  for (auto& t : mesh.triangles)
    for (uint32_t& v : t) {
      from.push_back(v);
      v = uint32_t(from.size() - 1);
    }
  gather_vertices(mesh, from);
  mesh.normals.reserve(from.size() + 2);
  for (const auto& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    Vec3f n(normalize(cross(b - a, c - a)));
    if (!(dot(n, n) > 0.5f)) n = {0, 1, 0};
    mesh.normals.insert(mesh.normals.end(), 3, n);
  }
}

using Key = std::array<uint32_t, 8>;
struct KeyHash {
  size_t operator()(const Key& key) const noexcept {
    uint64_t h = 0x9E3779B97F4A7C15u;
    for (const uint32_t k : key) {
      h = (h ^ k) * 0xD6E8FEB86659FD93u;
      h ^= h >> 32;
    }
    return size_t(h);
  }
};

/// For each vertex the first of those equal to it in position, normal and UV.
std::vector<uint32_t> weld(const TriangleMesh& mesh, const std::vector<Vec2f>& uvs) {
  std::unordered_map<Key, uint32_t, KeyHash> seen;
  seen.reserve(mesh.positions.size());
  std::vector<uint32_t> first(mesh.positions.size());
  const auto bits = [](float f) { return std::bit_cast<uint32_t>(f == 0 ? 0.0f : f); };  // -0 equals 0
  for (uint32_t v = 0; v < first.size(); ++v) {
    const Vec3f &p = mesh.positions[v], &n = mesh.normals[v];
    const Vec2f& uv = uvs[v];
    const Key key{bits(p.x), bits(p.y), bits(p.z), bits(n.x), bits(n.y), bits(n.z), bits(uv.x), bits(uv.y)};
    first[v] = seen.try_emplace(key, v).first->second;
  }
  return first;
}

Vec3d reject(const Vec3d& v, const Vec3d& n) { return normalize(v - n * dot(v, n)); }

Vec3d any_perpendicular(const Vec3d& n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  return reject(x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, n);
}

using Corners = std::array<Vec3d, 3>;

Corners corner_positions(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  return {Vec3d(mesh.positions[t[0]]), Vec3d(mesh.positions[t[1]]), Vec3d(mesh.positions[t[2]])};
}

Vec3d unit_normal(const TriangleMesh& mesh, uint32_t v) { return normalize(Vec3d(mesh.normals[v])); }

struct FaceTangent {
  Vec3d along_u;  // of any length
  Turn turn = kNoTurn;
};

/// The direction in which u grows over a triangle; no turn where it has no area in space or in UV.
FaceTangent face_tangent(const Corners& p, const Vec2f& a, const Vec2f& b, const Vec2f& c) {
  const Vec3d d1 = p[1] - p[0], d2 = p[2] - p[0];
  const double u1 = double(b.x) - double(a.x), u2 = double(c.x) - double(a.x);
  const double v1 = double(a.y) - double(b.y), v2 = double(a.y) - double(c.y);  // v' = 1 - v
  const double area = u1 * v2 - u2 * v1;
  const Vec3d along_u = d1 * v2 - d2 * v1, along_v = d2 * u1 - d1 * u2;
  if (!(std::abs(area) > double(FLT_MIN)) || p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return {};
  if (!(dot(along_u, along_u) > 0) || !(dot(along_v, along_v) > 0)) return {};
  return area > 0 ? FaceTangent{along_u, kUpright} : FaceTangent{-along_u, kMirrored};
}

/// The angle at corner k, seen along the normal n.
double corner_angle(const Corners& p, size_t k, const Vec3d& n) {
  const Vec3d a = reject(p[(k + 1) % 3] - p[k], n), b = reject(p[(k + 2) % 3] - p[k], n);
  return std::acos(std::clamp(dot(a, b), -1.0, 1.0));
}

/// What the triangles around each vertex say, summed over welded vertices.
struct TangentSums {
  std::vector<uint32_t> first;              // by vertex: the one that stands for its weld
  std::vector<std::array<Vec3d, 2>> sum;    // by weld and turn
  std::vector<Turn> turn;                   // by triangle
  std::vector<uint8_t> of_vertex, of_weld;  // bit s: a triangle of turn s uses it
};

TangentSums sum_tangents(const TriangleMesh& mesh, const std::vector<Vec2f>& uvs) {
  const size_t count = mesh.positions.size();
  TangentSums s{weld(mesh, uvs), {}, {}, {}, {}};
  s.sum.resize(count), s.of_vertex.resize(count), s.of_weld.resize(count);
  s.turn.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Corners p = corner_positions(mesh, t);
    const FaceTangent face = face_tangent(p, uvs[t[0]], uvs[t[1]], uvs[t[2]]);
    s.turn.push_back(face.turn);
    if (face.turn == kNoTurn) continue;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = t[k], w = s.first[v];
      s.of_vertex[v] = uint8_t(s.of_vertex[v] | 1u << face.turn);
      s.of_weld[w] = uint8_t(s.of_weld[w] | 1u << face.turn);
      const Vec3d n = unit_normal(mesh, v), weighted = reject(face.along_u, n) * corner_angle(p, k, n);
      if (is_finite(weighted)) s.sum[w][face.turn] += weighted;
    }
  }
  return s;
}

struct Split {
  std::vector<uint32_t> from;  // by new vertex: the old one that it copies
  std::vector<Turn> turn;      // by new vertex
};

/// Makes every vertex serve one turn: it goes with the first triangle that uses it, its copy with those that turn the
/// other way. Triangles are redirected.
Split split_by_turn(TriangleMesh& mesh, const TangentSums& sums) {
  const size_t count = mesh.positions.size();
  Split split{std::vector<uint32_t>(count), std::vector<Turn>(count, kNoTurn)};
  for (uint32_t v = 0; v < count; ++v) split.from[v] = v;
  std::vector<uint32_t> copy(count, kUnset);
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    for (uint32_t& v : mesh.triangles[i]) {
      const uint8_t around = sums.of_vertex[v] ? sums.of_vertex[v] : sums.of_weld[sums.first[v]];
      const Turn turn = sums.turn[i] != kNoTurn ? sums.turn[i] : around == 1u << kMirrored ? kMirrored : kUpright;
      if (split.turn[v] == kNoTurn) split.turn[v] = turn;
      if (split.turn[v] == turn) continue;
      if (copy[v] == kUnset) {
        copy[v] = uint32_t(split.from.size());
        split.from.push_back(v);
        split.turn.push_back(turn);
      }
      v = copy[v];
    }
  return split;
}

Vec3d tangent_at(const Vec3d& sum, const Vec3d& n) {
  const Vec3d t = reject(normalize(sum), n);
  return std::abs(dot(t, t) - 1) < 1e-6 && std::abs(dot(t, n)) < 1e-6 ? t : any_perpendicular(n);
}

}  // namespace

void generate_tangents(TriangleMesh& mesh, uint32_t uv_set) {
  if (uv_set >= mesh.uvs.size() || mesh.uvs[uv_set].size() != mesh.positions.size()) return;
  const bool flat = mesh.normals.empty();
  const uint64_t vertices = flat ? uint64_t{mesh.triangles.size()} * 3 : uint64_t{mesh.positions.size()};
  if (vertices * 2 >= kUnset) return;
  if (flat) make_flat_normals(mesh);

  const TangentSums sums = sum_tangents(mesh, mesh.uvs[uv_set]);
  const Split split = split_by_turn(mesh, sums);
  mesh.tangents.clear();
  mesh.tangents.reserve(split.from.size() + 2);
  for (size_t i = 0; i < split.from.size(); ++i) {
    const uint32_t v = split.from[i];
    const Turn turn = split.turn[i] == kMirrored ? kMirrored : kUpright;
    const Vec3d t = tangent_at(sums.sum[sums.first[v]][turn], unit_normal(mesh, v));
    mesh.tangents.push_back({float(t.x), float(t.y), float(t.z), turn == kMirrored ? -1.0f : 1.0f});
  }
  if (split.from.size() > mesh.positions.size()) gather_vertices(mesh, split.from);
  mesh.positions.reserve(mesh.positions.size() + 2);
}

}  // namespace alhazen
