// Points on surfaces for hits side by side (renderer/surface.h).
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "accel/line_map.h"
#include "accel/shapes/polygon_plane.h"
#include "core/lane_memory.h"
#include "renderer/shape_point.h"
#include "renderer/triangle_point.h"

namespace alhazen {
namespace {

using F = ShadingLanes;
using D = DoubleOf<F>;
using U = UintOf<F>;

constexpr uint32_t kEveryLane = (1u << kWidthOf<F>)-1;

const TriangleMesh& part_of(const Scene& scene, const LaneHits& hits, size_t lane) {
  return part_of(scene.geometry, hits.object[lane], hits.part[lane]);
}

/// The lanes that are on the object, part or triangle of one of them.
MaskOf<U> on_object_of(const LaneHits& hits, size_t lane) { return hits.object.load() == U(hits.object[lane]); }
MaskOf<U> on_part_of(const LaneHits& hits, size_t lane) {
  return on_object_of(hits, lane) && hits.part.load() == U(hits.part[lane]);
}
MaskOf<U> on_triangle_of(const LaneHits& hits, size_t lane) {
  return on_part_of(hits, lane) && hits.primitive.load() == U(hits.primitive[lane]);
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
    for (size_t i = 0; i < count; ++i) {
      parts_[i] = &part_of(scene, hits, lanes[i]), triangles_[i] = hits.primitive[lanes[i]];
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

Affine3<D> lane_maps(const std::array<const Affine3d*, kWidthOf<F>>& maps) {
  const auto column = [&](Vec3d Affine3d::*of) {
    Vec3Array<D> all;
    for (size_t k = 0; k < kWidthOf<F>; ++k) all.set(k, maps[k]->*of);
    return all.load();
  };
  return {column(&Affine3d::x), column(&Affine3d::y), column(&Affine3d::z), column(&Affine3d::origin)};
}

Affine3<D> broadcast(const Affine3d& m) {
  const auto all = [](const Vec3d& v) { return Vec3<D>(D(v.x), D(v.y), D(v.z)); };
  return {all(m.x), all(m.y), all(m.z), all(m.origin)};
}

/// The triangles of hits on meshes.
struct LaneTriangles {
  Corners<F> corners;
  std::optional<Affine3<D>> world_from_object;  // none where all lie in the world
  D roundings;                                  // of a position, in units of kUlp

  [[nodiscard]] const Affine3<D>* map() const { return world_from_object ? &*world_from_object : nullptr; }
};

double position_roundings(const Affine3d& m) { return m == Affine3d{} ? 4 : 16; }

void set_maps(const MeshInstances& instances, const LaneHits& hits, LaneTriangles& all) {
  const auto is_on = [&](size_t k, size_t other) { return hits.object[k] == hits.object[other]; };
  if (lane_bits(on_object_of(hits, 0)) == kEveryLane) {
    const Affine3d m = instances.world_from_object(hits.object[0]);
    all.roundings = D(position_roundings(m));
    if (m != Affine3d{}) all.world_from_object = broadcast(m);
    return;
  }
  std::array<Affine3d, kWidthOf<F>> maps;  // of each object that the lane before is not on
  std::array<const Affine3d*, kWidthOf<F>> map_of;
  LaneArray<D> roundings;
  bool all_in_world = true;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    if (k > 0 && is_on(k, k - 1)) {
      map_of[k] = map_of[k - 1], roundings[k] = roundings[k - 1];
      continue;
    }
    maps[k] = instances.world_from_object(hits.object[k]);
    map_of[k] = &maps[k], roundings[k] = position_roundings(maps[k]);
    all_in_world = all_in_world && maps[k] == Affine3d{};
  }
  all.roundings = roundings.load();
  if (!all_in_world) all.world_from_object = lane_maps(map_of);
}

LaneTriangles lane_triangles(const Scene& scene, const LaneHits& hits, const Attributes& has) {
  LaneTriangles all;
  all.corners = lane_corners(scene, hits, has);
  set_maps(scene.geometry.mesh_instances, hits, all);
  return all;
}

void set_mesh_points(const Scene& scene, const LaneHits& hits, const Attributes& has, bool measure,
                     BasicSurfacePoint<F>& s) {
  const LaneTriangles triangles = lane_triangles(scene, hits, has);
  const F u = hits.u.load(), v = hits.v.load();
  interpolate_attributes(triangles.corners, has, u, v, s);
  if (measure) measure_uvs(triangles.corners, has, triangles.map(), s);
  place(triangles.corners, has, u, v, triangles.map(), triangles.roundings, s);
}

using LaneShapes = std::array<const Shape*, kWidthOf<F>>;

/// One sphere, or sphere by sphere.
struct LaneSpheres {
  using Kind = Sphere;
  D radius;

  explicit LaneSpheres(const Sphere& sphere) : radius(sphere.radius) {}
  explicit LaneSpheres(const LaneShapes& shapes)
      : radius([&](auto k) { return std::get_if<Sphere>(shapes[k])->radius; }) {}

  [[nodiscard]] uint32_t doubtful(const LaneHits&) const { return 0; }
  [[nodiscard]] Vec3<D> projected(const Vec3<D>& p) const { return normalize(p) * radius; }
  [[nodiscard]] static Vec3<D> normal(const Vec3<D>& p) { return normalize(p); }
};

/// The same of quadrics; caps and double planes are left to be done one by one.
struct LaneQuadrics {
  using Kind = Quadric;
  std::array<D, 10> coefficients;

  explicit LaneQuadrics(const Quadric& quadric) {
    for (size_t c = 0; c < coefficients.size(); ++c) coefficients[c] = D(quadric.coefficients[c]);
  }
  explicit LaneQuadrics(const LaneShapes& shapes) {
    for (size_t c = 0; c < coefficients.size(); ++c)
      coefficients[c] = D([&](auto k) { return std::get_if<Quadric>(shapes[k])->coefficients[c]; });
  }

  [[nodiscard]] uint32_t doubtful(const LaneHits& hits) const {
    return lane_bits(may_be_square(coefficients)) | lane_bits(hits.part.load() != U(uint32_t(kWallFace)));
  }
  [[nodiscard]] Vec3<D> projected(const Vec3<D>& p) const { return project_to_wall(coefficients, p); }
  [[nodiscard]] Vec3<D> normal(const Vec3<D>& p) const {
    return scaled_to_unit(quadric_half_gradient(coefficients, p));
  }
};

/// The hits in the shapes' spaces, about where their surfaces are.
Vec3<D> object_points(const LaneHits& hits, const Affine3<D>& object_from_world, const Vec3<D>& origin_world) {
  const Vec3<D> along = convert<D>(hits.direction.load()) * convert<D>(hits.t.load());
  return transform_vector(object_from_world, convert<D>(hits.origin.load()) - origin_world + along);
}

/// Where shapes stand: all lanes' at one place, or each at its own.
struct LanePlaces {
  Affine3<D> world_from_object, object_from_world;
  D stretch;  // of volumes, below 0 where the map mirrors

  explicit LanePlaces(const Affine3d& m)
      : world_from_object(broadcast(m)), object_from_world(broadcast(inverse(m))), stretch(determinant(m)) {}
  explicit LanePlaces(const Affine3<D>& m)
      : world_from_object(m), object_from_world(inverse(m)), stretch(determinant(m)) {}
};

/// What `shape_point` does, for shapes of one kind, but for texture coordinates. Answers the lanes that are left.
template <class Shapes>
uint32_t set_points_on(const Shapes& shapes, const LanePlaces& places, const LaneHits& hits, BasicSurfacePoint<F>& s) {
  const Affine3<D>& m = places.world_from_object;
  const Vec3<D> p = shapes.projected(object_points(hits, places.object_from_world, m.origin));
  s.p_world = transform_point(m, p);
  s.ng_world = s.ns_world = convert<F>(normalize(outer_normal(m, places.stretch, shapes.normal(p))));
  s.offset = shape_offset<F>(s.p_world);
  return shapes.doubtful(hits);
}

/// The same for one polygon, with its texture coordinates: in all lanes lie one plane's.
void set_points_on(const Polygon& polygon, const Affine3d& m, const LaneHits& hits, BasicSurfacePoint<F>& s) {
  const Vec3d ng = normalize(transform_normal(m, polygon.unit_normal)), center = polygon.center;
  const Affine3<D> all = broadcast(m);
  const Vec3<D> p = nearest_in_plane(polygon, object_points(hits, broadcast(inverse(m)), all.origin));
  s.p_world = transform_point(all, p);
  s.ng_world = s.ns_world = broadcast<F>(Vec3f(ng));
  s.offset = shape_offset<F>(s.p_world);
  s.tangent_world = broadcast<F>(Vec3f(normalize(transform_vector(m, u_tangent(polygon, center, 0)))));
  s.bitangent_sign = F(bitangent_sign(m));
  const Vec2<D> uv = uv_in_plane(polygon, p);
  s.uvs[0] = {convert<F>(uv.x), convert<F>(uv.y)};
}

/// For one shape that all hits are on. Answers the lanes that are left.
uint32_t set_points_on_one(const ShapeInstance& placed, const Shape& shape, bool has_textures, const LaneHits& hits,
                           BasicSurfacePoint<F>& s) {
  const Affine3d& m = placed.world_from_object;
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return set_points_on(*polygon, m, hits, s), 0;
  if (has_textures) return kEveryLane;
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return set_points_on(LaneSpheres(*sphere), LanePlaces(m), hits, s);
  if (const auto* quadric = std::get_if<Quadric>(&shape))
    return set_points_on(LaneQuadrics(*quadric), LanePlaces(m), hits, s);
  return kEveryLane;
}
/// For shapes that are all of one kind, else nothing. Answers the lanes that are left.
template <class Shapes>
uint32_t set_points_on_each(const std::array<const ShapeInstance*, kWidthOf<F>>& placed, const LaneShapes& shapes,
                            const LaneHits& hits, BasicSurfacePoint<F>& s) {
  std::array<const Affine3d*, kWidthOf<F>> maps;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    if (!std::holds_alternative<typename Shapes::Kind>(*shapes[k])) return kEveryLane;
    maps[k] = &placed[k]->world_from_object;
  }
  return set_points_on(Shapes(shapes), LanePlaces(lane_maps(maps)), hits, s);
}

/// Answers the lanes that are left.
uint32_t set_points_in_lanes(const Scene& scene, const LaneHits& hits, bool has_textures, BasicSurfacePoint<F>& s) {
  const Geometry& geometry = scene.geometry;
  std::array<const ShapeInstance*, kWidthOf<F>> placed;
  LaneShapes shapes;
  const auto find = [&](size_t k) {
    placed[k] = &shape_instance(geometry, hits.object[k]), shapes[k] = &geometry.shapes[placed[k]->shape];
  };
  find(0);
  if (lane_bits(on_object_of(hits, 0)) == kEveryLane)
    return set_points_on_one(*placed[0], *shapes[0], has_textures, hits, s);
  if (has_textures) return kEveryLane;
  for (size_t k = 1; k < kWidthOf<F>; ++k) find(k);
  if (std::holds_alternative<Sphere>(*shapes[0])) return set_points_on_each<LaneSpheres>(placed, shapes, hits, s);
  if (std::holds_alternative<Quadric>(*shapes[0])) return set_points_on_each<LaneQuadrics>(placed, shapes, hits, s);
  return kEveryLane;
}

void set_points_one_by_one(const Scene& scene, const LaneHits& hits, bool has_textures, uint32_t lanes,
                           BasicSurfacePoint<F>& s) {
  Vec3Array<D> p;
  LaneArray<F> offset, bitangent_sign, u, v;
  Vec3Array<F> ng, ns, tangent;
  p.store(s.p_world), offset.store(s.offset), ng.store(s.ng_world), ns.store(s.ns_world);
  tangent.store(s.tangent_world), bitangent_sign.store(s.bitangent_sign);
  u.store(s.uvs[0].x), v.store(s.uvs[0].y);
  for (; lanes; lanes &= lanes - 1) {
    const auto k = size_t(std::countr_zero(lanes));
    const Rayf ray{hits.origin.get(k), hits.direction.get(k)};
    const SurfacePoint one = shape_point(scene, ray, hits.ids(k), hits.t[k], 0, has_textures);
    p.set(k, one.p_world), ng.set(k, one.ng_world), ns.set(k, one.ns_world), tangent.set(k, one.tangent_world);
    offset[k] = one.offset, bitangent_sign[k] = one.bitangent_sign;
    u[k] = one.uvs[0].x, v[k] = one.uvs[0].y;
  }
  s.p_world = p.load(), s.offset = offset.load();
  s.ng_world = ng.load(), s.ns_world = ns.load(), s.tangent_world = tangent.load();
  s.bitangent_sign = bitangent_sign.load();
  s.uvs[0] = {u.load(), v.load()};
}

void set_shape_points(const Scene& scene, const LaneHits& hits, bool has_textures, BasicSurfacePoint<F>& s) {
  const uint32_t left = set_points_in_lanes(scene, hits, has_textures, s);
  if (left != 0) set_points_one_by_one(scene, hits, has_textures, left, s);
  s.uv_count = 1;
}

}  // namespace

BasicSurfacePoint<F> surface_points(const Scene& scene, const LaneHits& hits, const Attributes& has,
                                    bool has_textures) noexcept {
  BasicSurfacePoint<F> s;
  if (is_shape(scene.geometry, hits.object[0]))
    set_shape_points(scene, hits, has_textures, s);
  else
    set_mesh_points(scene, hits, has, has_textures, s);
  return s;
}

F mean_curvature(const Scene& scene, const LaneHits& hits, const Attributes& has, const BasicSurfacePoint<F>& points,
                 const F& width) noexcept {
  if (is_shape(scene.geometry, hits.object[0])) {
    Vec3Array<D> p;
    Vec3Array<F> ng;
    LaneArray<F> widths, curvature;
    p.store(points.p_world), ng.store(points.ng_world), widths.store(width);
    for (size_t k = 0; k < kWidthOf<F>;) {
      const uint32_t object = hits.object[k];
      const ShapeCurvature on_shape(scene, object, 0);
      for (; k < kWidthOf<F> && hits.object[k] == object; ++k)
        curvature[k] = on_shape.at(int(hits.part[k]), p.get(k), ng.get(k), widths[k]);
    }
    return finite_or_0(curvature.load());
  }
  if (!has.normals) return F(0);
  const LaneTriangles triangles = lane_triangles(scene, hits, {.normals = true});
  return finite_or_0(mesh_curvature(triangles.corners, triangles.map()));
}

}  // namespace alhazen
