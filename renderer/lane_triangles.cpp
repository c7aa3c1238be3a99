#include "renderer/lane_triangles.h"

#include <array>
#include <bit>
#include <utility>

#include "core/lane_memory.h"

namespace alhazen {
namespace {

using F = ShadingLanes;
using D = DoubleOf<F>;
using U = UintOf<F>;

const TriangleMesh& part_of(const Scene& scene, const LaneHits& hits, size_t lane) {
  return part_of(scene.geometry, hits.object[lane], hits.part[lane]);
}

/// Where each lane's part has its arrays; of those that it lacks nothing is asked.
class LaneParts {
 public:
  LaneParts(const Scene& scene, const LaneHits& hits) {
    one_part_ = lane_bits(on_part_of(hits, 0)) == kEveryLane, parts_[0] = &part_of(scene, hits, 0);
    for (size_t k = 1; k < kWidthOf<F>; ++k) parts_[k] = one_part_ ? parts_[0] : &part_of(scene, hits, k);
  }

  /// An array in each lane.
  struct Rows {
    AddressOf<F> first;
    size_t stride;

    [[nodiscard]] AddressOf<F> operator[](const IntOf<F>& index) const {
      const AddressOf<F> number = convert<AddressOf<F>>(index) & AddressOf<F>(0xFFFFFFFFu);  // they are unsigned
      return first + number * AddressOf<F>(stride);
    }
  };
  /// The array `of(part)`.
  template <class Of>
  [[nodiscard]] Rows rows(const Of& of) const {
    using T = typename std::remove_cvref_t<decltype(of(*parts_[0]))>::value_type;
    const auto base = [&](const TriangleMesh* part) { return uint64_t(reinterpret_cast<uintptr_t>(of(*part).data())); };
    if (one_part_) return {AddressOf<F>(base(parts_[0])), sizeof(T)};
    LaneArray<AddressOf<F>> bases;
    for (size_t k = 0; k < kWidthOf<F>; ++k) bases[k] = base(parts_[k]);
    return {bases.load(), sizeof(T)};
  }
  template <class T>
  [[nodiscard]] Rows rows(T TriangleMesh::*member) const {
    return rows([=](const TriangleMesh& part) -> const auto& { return part.*member; });
  }

  [[nodiscard]] Vec3<F> polygon_normals(const LaneArray<U>& triangles) const {
    Vec3Array<F> n;
    for (size_t k = 0; k < kWidthOf<F>; ++k) n.set(k, parts_[k]->polygon_normals[polygon_of(*parts_[k], triangles[k])]);
    return n.load();
  }

 private:
  std::array<const TriangleMesh*, kWidthOf<F>> parts_;
  bool one_part_;
};

/// The triangles of hits, each lane's for itself: what is asked of their corners is gathered.
class LanesOfTriangles {
 public:
  LanesOfTriangles(const Scene& scene, const LaneHits& hits) : parts_(scene, hits), triangles_(hits.primitive) {
    corner_ = load_triples_at<IntOf<F>>(parts_.rows(&TriangleMesh::triangles)[convert<IntOf<F>>(triangles_.load())]);
  }

  template <class Of>
  [[nodiscard]] Vec2<F> vec2(const Of& of, size_t corner) const {
    const AddressOf<F> both = load_words_at<F>(parts_.rows(of)[corner_[corner]]);
    const auto half = [](const AddressOf<F>& word) { return std::bit_cast<F>(convert<IntOf<F>>(word)); };
    return {half(both), half(both >> 32)};
  }
  template <class Of>
  [[nodiscard]] Vec3<F> vec3(const Of& of, size_t corner) const {
    const auto [x, y, z] = load_triples_at<F>(parts_.rows(of)[corner_[corner]]);
    return {x, y, z};
  }
  template <class Of>
  [[nodiscard]] F fourth(const Of& of, size_t corner) const {
    return load_at<F>(parts_.rows(of)[corner_[corner]] + AddressOf<F>(3 * sizeof(float)));
  }
  [[nodiscard]] Vec3<F> polygon_normals() const { return parts_.polygon_normals(triangles_); }

 private:
  LaneParts parts_;
  LaneArray<U> triangles_;
  std::array<IntOf<F>, 3> corner_;
};

/// A few triangles that all hits are on: what is asked of their corners is read once for each.
template <size_t count>
class FewTriangles {
 public:
  /// `lanes`: the first on each triangle.
  FewTriangles(const Scene& scene, const LaneHits& hits, const std::array<size_t, count>& lanes) {
    const bool one_part = lane_bits(on_part_of(hits, 0)) == kEveryLane;
    for (size_t i = 0; i < count; ++i) {
      parts_[i] = one_part && i > 0 ? parts_[0] : &part_of(scene, hits, lanes[i]);
      triangles_[i] = hits.primitive[lanes[i]];
      on_[i] = convert_mask<F>(on_triangle_of(hits, lanes[i]));
    }
  }

  template <class Of>
  [[nodiscard]] Vec2<F> vec2(const Of& of, size_t corner) const {
    return {number<0>(of, corner), number<1>(of, corner)};
  }
  template <class Of>
  [[nodiscard]] Vec3<F> vec3(const Of& of, size_t corner) const {
    return {number<0>(of, corner), number<1>(of, corner), number<2>(of, corner)};
  }
  template <class Of>
  [[nodiscard]] F fourth(const Of& of, size_t corner) const {
    return number<3>(of, corner);
  }
  [[nodiscard]] Vec3<F> polygon_normals() const {
    const auto normal = [&](size_t i) { return parts_[i]->polygon_normals[polygon_of(*parts_[i], triangles_[i])]; };
    Vec3<F> n = broadcast<F>(normal(0));
    for (size_t i = 1; i < count; ++i) n = select(on_[i], broadcast<F>(normal(i)), n);
    return n;
  }

 private:
  template <size_t n, class Of>
  [[nodiscard]] F number(const Of& of, size_t corner) const {
    const auto of_triangle = [&](size_t i) {
      const auto& element = of(*parts_[i])[parts_[i]->triangles[triangles_[i]][corner]];
      return F(reinterpret_cast<const float*>(&element)[n]);
    };
    F all = of_triangle(0);
    for (size_t i = 1; i < count; ++i) all = select(on_[i], of_triangle(i), all);
    return all;
  }

  std::array<const TriangleMesh*, count> parts_;
  std::array<uint32_t, count> triangles_;
  std::array<MaskOf<F>, count> on_;
};

template <class Triangles>
Corners<F> corners_of(const Triangles& triangles, const Attributes& has) {
  Corners<F> c;
  if (has.polygon_normals) c.n_polygon = triangles.polygon_normals();
  const auto positions = [](const TriangleMesh& part) -> const auto& { return part.positions; };
  const auto normals = [](const TriangleMesh& part) -> const auto& { return part.normals; };
  const auto tangents = [](const TriangleMesh& part) -> const auto& { return part.tangents; };
  const auto colors = [](const TriangleMesh& part) -> const auto& { return part.colors; };
  for (size_t k = 0; k < 3; ++k) c.p_object[k].store(triangles.vec3(positions, k));
  for (size_t k = 0; k < 3 && has.normals; ++k) c.n_object[k].store(triangles.vec3(normals, k));
  for (size_t k = 0; k < 3 && has.tangents; ++k) c.t_object[k].store(triangles.vec3(tangents, k));
  if (has.tangents) c.handedness = triangles.fourth(tangents, 0);
  for (size_t i = 0; i < has.uv_sets; ++i) {
    const auto uvs = [i](const TriangleMesh& part) -> const auto& { return part.uvs[i]; };
    for (size_t k = 0; k < 3; ++k) c.uvs[i][k].store(triangles.vec2(uvs, k));
  }
  for (size_t k = 0; k < 3 && has.colors; ++k) {
    const Vec3<F> rgb = triangles.vec3(colors, k);
    c.colors[k].store({rgb.x, rgb.y, rgb.z}), c.alphas[k].store(triangles.fourth(colors, k));
  }
  return c;
}

constexpr size_t kFew = 4;  // triangles of a block, up to which they are read one by one

/// The first lane on each triangle of a block, up to kFew; how many those are, or more than kFew.
size_t find_triangles(const LaneHits& hits, std::array<size_t, kFew>& lanes) {
  size_t count = 0;
  for (uint32_t left = kEveryLane; left != 0; ++count) {
    if (count == kFew) return kFew + 1;
    const auto lane = size_t(std::countr_zero(left));
    lanes[count] = lane;
    left &= ~lane_bits(on_triangle_of(hits, lane));
  }
  return count;
}

Corners<F> lane_corners(const Scene& scene, const LaneHits& hits, const Attributes& has) {
  std::array<size_t, kFew> lanes;
  const auto few = [&]<size_t... i>(std::index_sequence<i...>) {
    return corners_of(FewTriangles<sizeof...(i)>(scene, hits, {lanes[i]...}), has);
  };
  switch (find_triangles(hits, lanes)) {
    case 1:
      return few(std::make_index_sequence<1>());
    case 2:
      return few(std::make_index_sequence<2>());
    case 3:
      return few(std::make_index_sequence<3>());
    case 4:
      return few(std::make_index_sequence<4>());
    default:
      return corners_of(LanesOfTriangles(scene, hits), has);
  }
}

double position_roundings(const Affine3d& m) { return m == Affine3d{} ? 4 : 16; }

}  // namespace

LaneTriangles::LaneTriangles(const Scene& scene, const LaneHits& hits, const Attributes& has)
    : corners(lane_corners(scene, hits, has)) {
  set_maps(scene.geometry.mesh_instances, hits);
}

void LaneTriangles::set_maps(const MeshInstances& instances, const LaneHits& hits) {
  const auto is_on = [&](size_t k, size_t other) { return hits.object[k] == hits.object[other]; };
  if (lane_bits(on_object_of(hits, 0)) == kEveryLane) {
    const Affine3d m = instances.world_from_object(hits.object[0]);
    roundings = D(position_roundings(m));
    if (m != Affine3d{}) world_from_object = broadcast(m);
    return;
  }
  std::array<Affine3d, kWidthOf<F>> maps;  // of each object that the lane before is not on
  std::array<const Affine3d*, kWidthOf<F>> map_of;
  LaneArray<D> roundings_of;
  bool all_in_world = true;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    if (k > 0 && is_on(k, k - 1)) {
      map_of[k] = map_of[k - 1], roundings_of[k] = roundings_of[k - 1];
      continue;
    }
    maps[k] = instances.world_from_object(hits.object[k]);
    map_of[k] = &maps[k], roundings_of[k] = position_roundings(maps[k]);
    all_in_world = all_in_world && maps[k] == Affine3d{};
  }
  roundings = roundings_of.load();
  if (!all_in_world) world_from_object = lane_maps(map_of);
}

}  // namespace alhazen
