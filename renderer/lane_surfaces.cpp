// Points on surfaces for hits side by side (renderer/surface.h).
#include <bit>
#include <optional>

#include "accel/line_map.h"
#include "accel/shapes/polygon_plane.h"
#include "core/lane_memory.h"
#include "renderer/shape_point.h"
#include "renderer/triangle_point.h"

namespace alhazen {
namespace {

using F = ShadingLanes;
using D = DoubleOf<F>;

/// Where each lane's part has its arrays; of those that it lacks nothing is asked.
class LaneParts {
 public:
  LaneParts(const Scene& scene, const LaneHits& hits) {
    const Geometry& geometry = scene.geometry;
    const auto part = [&](size_t k) {
      return &geometry.meshes[geometry.mesh_instances.mesh_of(hits.ids[k].object)].parts[hits.ids[k].part];
    };
    const auto is_as_before = [&](size_t k) {
      return hits.ids[k].object == hits.ids[k - 1].object && hits.ids[k].part == hits.ids[k - 1].part;
    };
    one_part_ = true, parts_[0] = part(0);
    for (size_t k = 1; k < kWidthOf<F>; ++k) {
      parts_[k] = is_as_before(k) ? parts_[k - 1] : part(k);
      one_part_ = one_part_ && parts_[k] == parts_[0];
    }
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

  [[nodiscard]] Vec3<F> polygon_normals(const LaneArray<IntOf<F>>& triangles) const {
    Vec3Array<F> n;
    for (size_t k = 0; k < kWidthOf<F>; ++k)
      n.set(k, parts_[k]->polygon_normals[polygon_of(*parts_[k], uint32_t(triangles[k]))]);
    return n.load();
  }

 private:
  std::array<const TriangleMesh*, kWidthOf<F>> parts_;
  bool one_part_;
};

template <class N>
N component(const AddressOf<F>& element, size_t k) {
  return load_at<N>(element + AddressOf<F>(4 * k));
}
Vec2<F> load_vec2(const AddressOf<F>& element) {
  const AddressOf<F> both = load_words_at<F>(element);
  const auto half = [](const AddressOf<F>& word) { return std::bit_cast<F>(convert<IntOf<F>>(word)); };
  return {half(both), half(both >> 32)};
}
Vec3<F> load_vec3(const AddressOf<F>& element) {
  const auto [x, y, z] = load_triples_at<F>(element);
  return {x, y, z};
}

Corners<F> lane_corners(const LaneParts& parts, const Attributes& has, const LaneArray<IntOf<F>>& triangles) {
  Corners<F> c;
  if (has.polygon_normals) c.n_polygon = parts.polygon_normals(triangles);
  const auto corner = load_triples_at<IntOf<F>>(parts.rows(&TriangleMesh::triangles)[triangles.load()]);
  const auto for_each_corner = [&](const LaneParts::Rows& rows, const auto& visit) {
    for (size_t k = 0; k < 3; ++k) visit(k, rows[corner[k]]);
  };
  using Address = AddressOf<F>;
  for_each_corner(parts.rows(&TriangleMesh::positions),
                  [&](size_t k, const Address& p) { c.p_object[k] = load_vec3(p); });
  if (has.normals)
    for_each_corner(parts.rows(&TriangleMesh::normals),
                    [&](size_t k, const Address& n) { c.n_object[k] = load_vec3(n); });
  if (has.tangents)
    for_each_corner(parts.rows(&TriangleMesh::tangents), [&](size_t k, const Address& t) {
      c.t_object[k].store(load_vec3(t));
      if (k == 0) c.handedness = component<F>(t, 3);
    });
  for (size_t i = 0; i < has.uv_sets; ++i)
    for_each_corner(parts.rows([&](const TriangleMesh& part) -> const auto& { return part.uvs[i]; }),
                    [&](size_t k, const Address& uv) { c.uvs[i][k].store(load_vec2(uv)); });
  if (has.colors)
    for_each_corner(parts.rows(&TriangleMesh::colors), [&](size_t k, const Address& color) {
      const Vec3<F> rgb = load_vec3(color);
      c.colors[k].store({rgb.x, rgb.y, rgb.z}), c.alphas[k].store(component<F>(color, 3));
    });
  return c;
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
  const auto is_on = [&](size_t k, size_t other) { return hits.ids[k].object == hits.ids[other].object; };
  size_t alike = 1;
  while (alike < kWidthOf<F> && is_on(alike, 0)) ++alike;
  if (alike == kWidthOf<F>) {
    const Affine3d m = instances.world_from_object(hits.ids[0].object);
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
    maps[k] = instances.world_from_object(hits.ids[k].object);
    map_of[k] = &maps[k], roundings[k] = position_roundings(maps[k]);
    all_in_world = all_in_world && maps[k] == Affine3d{};
  }
  all.roundings = roundings.load();
  if (!all_in_world) all.world_from_object = lane_maps(map_of);
}

LaneTriangles lane_triangles(const Scene& scene, const LaneHits& hits, const Attributes& has) {
  LaneTriangles all;
  LaneArray<IntOf<F>> triangles;
  for (size_t k = 0; k < kWidthOf<F>; ++k) triangles[k] = int32_t(hits.ids[k].primitive);
  all.corners = lane_corners(LaneParts(scene, hits), has, triangles);
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

constexpr uint32_t kEveryLane = (1u << kWidthOf<F>)-1;

/// Sphere by sphere.
struct LaneSpheres {
  D radius;

  template <class ShapeOf>
  explicit LaneSpheres(const ShapeOf& shape_of)
      : radius([&](auto k) { return std::get_if<Sphere>(&shape_of(k))->radius; }) {}

  [[nodiscard]] uint32_t doubtful(const LaneHits&) const { return 0; }
  [[nodiscard]] Vec3<D> projected(const Vec3<D>& p) const { return normalize(p) * radius; }
  [[nodiscard]] static Vec3<D> normal(const Vec3<D>& p) { return normalize(p); }
};

/// Quadric by quadric; caps and double planes are left to be done one by one.
struct LaneQuadrics {
  std::array<D, 10> coefficients;

  template <class ShapeOf>
  explicit LaneQuadrics(const ShapeOf& shape_of) {
    for (size_t c = 0; c < coefficients.size(); ++c)
      coefficients[c] = D([&](auto k) { return std::get_if<Quadric>(&shape_of(k))->coefficients[c]; });
  }

  [[nodiscard]] uint32_t doubtful(const LaneHits& hits) const {
    uint32_t lanes = lane_bits(may_be_square(coefficients));
    for (size_t k = 0; k < kWidthOf<F>; ++k) lanes |= uint32_t(int(hits.ids[k].part) != kWallFace) << k;
    return lanes;
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

/// What `shape_point` does, for shapes of one kind, but for texture coordinates. Answers the lanes that are left.
template <class LaneShapes, class ShapeOf>
uint32_t set_points_on(const LaneHits& hits, const Affine3<D>& m, const ShapeOf& shape_of, BasicSurfacePoint<F>& s) {
  const LaneShapes shapes(shape_of);
  const Vec3<D> p = shapes.projected(object_points(hits, inverse(m), m.origin));
  s.p_world = transform_point(m, p);
  s.ng_world = s.ns_world = convert<F>(normalize(outer_normal(m, determinant(m), shapes.normal(p))));
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

/// Answers the lanes that are left.
uint32_t set_points_in_lanes(const Scene& scene, const LaneHits& hits, bool has_textures, BasicSurfacePoint<F>& s) {
  const Geometry& geometry = scene.geometry;
  std::array<const ShapeInstance*, kWidthOf<F>> placed;
  std::array<const Shape*, kWidthOf<F>> shapes;
  bool alike = true, one = true;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    placed[k] = &shape_instance(geometry, hits.ids[k].object), shapes[k] = &geometry.shapes[placed[k]->shape];
    alike = alike && shapes[k]->index() == shapes[0]->index(), one = one && placed[k] == placed[0];
  }
  if (const auto* polygon = std::get_if<Polygon>(shapes[0]); one && polygon)
    return set_points_on(*polygon, placed[0]->world_from_object, hits, s), 0;
  const bool spheres = std::holds_alternative<Sphere>(*shapes[0]),
             quadrics = std::holds_alternative<Quadric>(*shapes[0]);
  if (has_textures || !alike || !(spheres || quadrics)) return kEveryLane;
  const auto shape_of = [&](size_t k) -> const Shape& { return *shapes[k]; };
  std::array<const Affine3d*, kWidthOf<F>> maps;
  for (size_t k = 0; k < kWidthOf<F>; ++k) maps[k] = &placed[k]->world_from_object;
  const Affine3<D> m = lane_maps(maps);
  return spheres ? set_points_on<LaneSpheres>(hits, m, shape_of, s) : set_points_on<LaneQuadrics>(hits, m, shape_of, s);
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
    const SurfacePoint one = shape_point(scene, ray, hits.ids[k], hits.t[k], 0, has_textures);
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
  if (is_shape(scene.geometry, hits.ids[0].object))
    set_shape_points(scene, hits, has_textures, s);
  else
    set_mesh_points(scene, hits, has, has_textures, s);
  return s;
}

F mean_curvature(const Scene& scene, const LaneHits& hits, const Attributes& has, const BasicSurfacePoint<F>& points,
                 const F& width) noexcept {
  if (is_shape(scene.geometry, hits.ids[0].object)) {
    Vec3Array<D> p;
    Vec3Array<F> ng;
    LaneArray<F> widths, curvature;
    p.store(points.p_world), ng.store(points.ng_world), widths.store(width);
    for (size_t k = 0; k < kWidthOf<F>;) {
      const uint32_t object = hits.ids[k].object;
      const ShapeCurvature on_shape(scene, object, 0);
      for (; k < kWidthOf<F> && hits.ids[k].object == object; ++k)
        curvature[k] = on_shape.at(int(hits.ids[k].part), p.get(k), ng.get(k), widths[k]);
    }
    return finite_or_0(curvature.load());
  }
  if (!has.normals) return F(0);
  const LaneTriangles triangles = lane_triangles(scene, hits, {.normals = true});
  return finite_or_0(mesh_curvature(triangles.corners, triangles.map()));
}

}  // namespace alhazen
