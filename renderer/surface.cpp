#include "renderer/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "accel/line_map.h"
#include "accel/posed.h"
#include "accel/shapes/polygon_plane.h"
#include "core/lane_memory.h"
#include "materials/microfacet.h"

namespace alhazen {
namespace {

constexpr double kUlp = 0x1p-24;  // half the spacing of floats, relative

/// What a triangle brings from the corners of its part, as far as the part has it. What it mostly lacks is kept in
/// memory that nobody sets to 0.
template <class F>
struct Corners {
  std::array<Vec3<F>, 3> p_object, n_object;
  std::array<Vec3Array<F>, 3> t_object;
  Vec3<F> n_polygon;  // in object space
  F handedness;       // of the first tangent
  std::array<std::array<Vec2Array<F>, 3>, kMaxUvSets> uvs;
  std::array<RgbArray<F>, 3> colors;
  std::array<LaneArray<F>, 3> alphas;
};

/// The three corners' values.
template <class Array>
auto loaded(const std::array<Array, 3>& corner) {
  return std::array{corner[0].load(), corner[1].load(), corner[2].load()};
}

template <class V, class F>
V interpolated(const std::array<V, 3>& corner, const F& u, const F& v) {
  return corner[0] * (F(1) - u - v) + corner[1] * u + corner[2] * v;
}

/// (M^-1)^T n times |det M|.
template <class D>
Vec3<D> outer_normal(const Affine3<D>& m, const D& stretch, const Vec3<D>& n) {
  const Vec3<D> v = cross(m.y, m.z) * n.x + cross(m.z, m.x) * n.y + cross(m.x, m.y) * n.z;
  return select(stretch < D(0), -v, v);
}

/// Traversal computes a triangle's normal in floats in object space, as a cross product of its edges, and with it the
/// plane's distance from a ray that starts up to the longest edge away from a vertex: wrong by this over twice the
/// area. For needles that is many roundings; for a triangle of no area, more than its size would hide nothing any more.
template <class F>
DoubleOf<F> plane_error(const std::array<Vec3<F>, 3>& corner, const DoubleOf<F>& twice_area) {
  using D = DoubleOf<F>;
  const F ab = length(corner[1] - corner[0]), bc = length(corner[2] - corner[1]), ca = length(corner[0] - corner[2]);
  const F low = smaller(ab, bc), high = larger(ab, bc);
  const F shortest = smaller(low, ca), middle = larger(low, smaller(high, ca)), longest = larger(high, ca);
  return convert<D>(longest) * smaller(D(D(8 * kUlp) * convert<D>(shortest) * convert<D>(middle)), twice_area);
}

/// Position, normals and their errors. `m`: to the world, or null for a part that lies there, to the same bits as with
/// the identity; `roundings`: of the position, in units of kUlp.
template <class F>
void place(const Corners<F>& corners, const Attributes& has, const F& u, const F& v, const Affine3<DoubleOf<F>>* m,
           const DoubleOf<F>& roundings, BasicSurfacePoint<F>& s) {
  using D = DoubleOf<F>;
  const auto vertex = [&](size_t k) { return convert<D>(corners.p_object[k]); };
  const Vec3<D> origin = vertex(0), e1 = vertex(1) - origin, e2 = vertex(2) - origin;
  const Vec3<D> p = origin + e1 * convert<D>(u) + e2 * convert<D>(v);
  s.p_world = m ? transform_point(*m, p) : p;
  const Vec3<D> across = cross(e1, e2),
                outward = m ? cross(transform_vector(*m, e1), transform_vector(*m, e2)) : across;
  const D squared = dot(outward, outward), length_outward = square_root(squared), reciprocal = D(1) / length_outward;
  const D stretch = m ? determinant(*m) : D(1);
  const Vec3<D> ng = select(squared > D(0), outward * reciprocal, outward);
  s.ng_world = s.ns_world = convert<F>(select(stretch < D(0), -ng, ng));

  const auto size_of = [](const Vec3<D>& x) { return larger(absolute(x.x), larger(absolute(x.y), absolute(x.z))); };
  const D twice_area = m ? length(across) : length_outward;
  D size = size_of(s.p_world), error = plane_error(corners.p_object, twice_area);
  if (m) size = size + size_of(m->origin), error = error * absolute(stretch);
  s.offset = convert<F>(D(D(kUlp) * roundings * size + error * reciprocal));

  if (has.normals || has.polygon_normals) {
    const Vec3<F> n = has.normals ? interpolated(corners.n_object, u, v) : corners.n_polygon;
    const Vec3<F> n_world =
        unit_vector(m ? convert<F>(outer_normal(*m, stretch, convert<D>(n)) * D(D(1) / absolute(stretch))) : n);
    const F n_squared = dot(n_world, n_world);
    s.ns_world = select(MaskOf<F>(n_squared > F(0) && n_squared - n_squared == F(0)), n_world, s.ns_world);
  }
  if (has.tangents) {
    const Vec3<F> t = interpolated(loaded(corners.t_object), u, v);
    s.tangent_world = unit_vector(m ? convert<F>(transform_vector(*m, convert<D>(t))) : t);
    s.bitangent_sign = select(convert_mask<F>(stretch < D(0)), F(-corners.handedness), corners.handedness);
  }
}

/// Texture coordinates and colour, and how fast the coordinates go over the triangle: the root of the ratio of the
/// areas.
template <class F>
void interpolate_attributes(const Corners<F>& corners, const Attributes& has, const F& u, const F& v,
                            BasicSurfacePoint<F>& s) {
  s.uv_count = int(has.uv_sets);
  for (size_t k = 0; k < has.uv_sets; ++k) s.uvs[k] = interpolated(loaded(corners.uvs[k]), u, v);
  if (!has.colors) return;
  s.color = {interpolated(loaded(corners.colors), u, v), interpolated(loaded(corners.alphas), u, v)};
}
template <class F>
void measure_uvs(const Corners<F>& corners, const Attributes& has, const Affine3<DoubleOf<F>>* m,
                 BasicSurfacePoint<F>& s) {
  using D = DoubleOf<F>;
  const auto vertex = [&](size_t k) {
    const Vec3<D> p = convert<D>(corners.p_object[k]);
    return m ? transform_point(*m, p) : p;
  };
  const Vec3<D> p0 = vertex(0);
  const F area = convert<F>(length(cross(vertex(1) - p0, vertex(2) - p0)));
  for (size_t k = 0; k < has.uv_sets; ++k) {
    const auto [a, b, c] = loaded(corners.uvs[k]);
    const F uv_area = absolute(F((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)));
    s.uv_per_metre[k] = select(area > F(0), square_root(F(uv_area / area)), F(0));
  }
}

Corners<float> corners_of(const PosedPart& posed, const TriangleMesh& part, const Attributes& has, uint32_t triangle) {
  const std::array<uint32_t, 3>& corner = part.triangles[triangle];
  Corners<float> c;
  if (has.polygon_normals) c.n_polygon = posed.polygon_normal(polygon_of(part, triangle));
  for (size_t k = 0; k < 3; ++k) {
    c.p_object[k] = posed.position(corner[k]);
    if (has.normals) c.n_object[k] = posed.normal(corner[k]);
    if (has.tangents) {
      const Vec4f t = posed.tangent(corner[k]);
      c.t_object[k].store({t.x, t.y, t.z});
      if (k == 0) c.handedness = t.w;
    }
    for (size_t i = 0; i < has.uv_sets; ++i) c.uvs[i][k].store(part.uvs[i][corner[k]]);
    if (has.colors) {
      const Vec4f& color = part.colors[corner[k]];
      c.colors[k].store({color.x, color.y, color.z}), c.alphas[k].store(color.w);
    }
  }
  return c;
}

SurfacePoint mesh_point(const Scene& scene, const HitIds& ids, float u, float v, float time) {
  const Geometry& geometry = scene.geometry;
  const uint32_t mesh = geometry.mesh_instances.mesh_of(ids.object);
  const TriangleMesh& part = geometry.meshes[mesh].parts[ids.part];
  const PosedPart posed(part, ids.part, track_of_mesh(geometry, mesh), time);
  const Affine3d m = world_from_object(geometry, ids.object, time);
  const Affine3d* map = m == Affine3d{} ? nullptr : &m;
  const Attributes has = attributes(part);
  const Corners<float> corners = corners_of(posed, part, has, ids.primitive);
  SurfacePoint s;
  s.material = part.material;
  interpolate_attributes(corners, has, u, v, s);
  measure_uvs(corners, has, map, s);
  // Rounding of the position, of an instance's ray transform, and of the traversal's plane; of both poses in motion.
  const bool moves = track_of_object(geometry, ids.object) || track_of_mesh(geometry, mesh);
  place(corners, has, u, v, map, moves ? 64.0 : map ? 16.0 : 4.0, s);
  return s;
}

/// Of a shape: v runs down.
float bitangent_sign(const Affine3d& m) { return determinant(m) < 0 ? 1.0f : -1.0f; }

/// `m`: from the shape's space to the world; `has_textures`: whether anybody asks for texture coordinates and tangents.
SurfacePoint shape_point(const Scene& scene, uint32_t object, int face, const Affine3d& m, const Vec3d& p_near_object,
                         bool has_textures = true) {
  const ShapeInstance& placed = shape_instance(scene.geometry, object);
  SurfacePoint s;
  s.material = placed.material;
  std::visit(
      [&](const auto& shape) {
        const Vec3d p = project(shape, p_near_object, face);
        s.p_world = transform_point(m, p);
        s.ng_world = s.ns_world = Vec3f(normalize(transform_normal(m, normal(shape, p, face))));
        if (!has_textures) return;
        s.tangent_world = Vec3f(normalize(transform_vector(m, u_tangent(shape, p, face))));
        s.bitangent_sign = bitangent_sign(m);
        s.uvs[0] = texture_coordinates(shape, p, face);
      },
      scene.geometry.shapes[placed.shape]);
  s.uv_count = 1;
  // The intersectors work in double on the float ray, so only the rounding of the origin has to be cleared.
  s.offset = float(2 * kUlp * max_component(abs(s.p_world)));
  return s;
}

/// Half the divergence of the normals, which are linear between the corners. Not a number where the triangle is none.
template <class F>
F mesh_curvature(const Corners<F>& corners, const Affine3<DoubleOf<F>>* m) {
  using D = DoubleOf<F>;
  const auto& p = corners.p_object;
  const D stretch = m ? determinant(*m) : D(1);
  const auto edge = [&](size_t k) {
    const Vec3<D> e = convert<D>(p[k]) - convert<D>(p[0]);
    return convert<F>(m ? transform_vector(*m, e) : e);
  };
  const auto normal = [&](size_t k) {
    const Vec3<F>& n = corners.n_object[k];
    return normalize(m ? convert<F>(outer_normal(*m, stretch, convert<D>(n))) : n);
  };
  const Vec3<F> e1 = edge(1), e2 = edge(2), across = cross(e1, e2), n0 = normal(0);
  // Per unit of each edge, times the vector that is 1 along it and 0 along the other.
  const F divergence = dot(normal(1) - n0, cross(e2, across)) + dot(normal(2) - n0, cross(across, e1));
  return divergence / (F(2) * dot(across, across));
}

/// A shape's surface about a point of it.
class ShapeSurroundings {
 public:
  /// Steps of about `width` metres to two sides.
  ShapeSurroundings(const Scene& scene, const HitIds& ids, const SurfacePoint& point, double width, float time)
      : world_from_object_(world_from_object(scene.geometry, ids.object, time)),
        object_from_world_(inverse(world_from_object_)),
        shape_(scene.geometry.shapes[shape_instance(scene.geometry, ids.object).shape]),
        face_(int(ids.part)),
        p_world_(point.p_world),
        ng_world_(point.ng_world),
        step_(std::max(width, 1e-6 * max_component(abs(point.p_world)))) {  // well above the rounding of double
    const ShadingFrame frame = frame_about(point.ng_world);
    sides_ = {Vec3d(frame.t), Vec3d(frame.b)};
  }

  /// From how far the normal leans outward at the steps, put back on the surface.
  [[nodiscard]] double mean_curvature() const {
    if (is_flat()) return 0;
    const Vec3d n(ng_world_);
    double turns = 0;
    for (const Vec3d& side : sides_) turns += dot(normal_near(p_world_ + side * step_) - n, side) / step_;
    return turns / 2;
  }

  /// The root of the ratio of the areas that the steps span.
  [[nodiscard]] float uv_per_metre() const {
    const Vec2f uv = uv_near(p_world_);
    std::array<Vec2d, 2> d;
    for (size_t k = 0; k < 2; ++k) {
      const Vec2f moved = uv_near(p_world_ + sides_[k] * step_);
      d[k] = {double(moved.x) - double(uv.x), double(moved.y) - double(uv.y)};
      d[k].x -= std::round(d[k].x);  // u starts anew at a seam
    }
    return float(std::sqrt(std::abs(d[0].x * d[1].y - d[0].y * d[1].x)) / step_);
  }

 private:
  [[nodiscard]] bool is_flat() const {
    return std::visit(
        []<class S>(const S&) {
          return std::is_same_v<S, Box> || std::is_same_v<S, Disk> || std::is_same_v<S, Polygon>;
        },
        shape_);
  }

  /// f(shape, point of its surface near p_world, face).
  template <class F>
  [[nodiscard]] auto near(const Vec3d& p_world, const F& f) const {
    const Vec3d p_object = transform_point(object_from_world_, p_world);
    return std::visit([&](const auto& shape) { return f(shape, project(shape, p_object, face_), face_); }, shape_);
  }
  [[nodiscard]] Vec3d normal_near(const Vec3d& p_world) const {
    return normalize(transform_normal(
        world_from_object_,
        near(p_world, [](const auto& shape, const Vec3d& p, int face) { return normal(shape, p, face); })));
  }
  [[nodiscard]] Vec2f uv_near(const Vec3d& p_world) const {
    return near(p_world,
                [](const auto& shape, const Vec3d& p, int face) { return texture_coordinates(shape, p, face); });
  }

  Affine3d world_from_object_, object_from_world_;
  const Shape& shape_;
  int face_;
  Vec3d p_world_;
  Vec3f ng_world_;
  double step_;
  std::array<Vec3d, 2> sides_;
};

}  // namespace

void SurfaceIdReader::look_up(const HitIds& hit) noexcept {
  const Geometry& geometry = scene_.geometry;
  // The default material is the last one, and none of the file's.
  const auto of_file = [&](uint32_t material) { return material + 1 == scene_.materials.size() ? kNone : material; };
  object_ = hit.object, part_ = hit.part;
  node_ = node_of(geometry, hit.object);
  first_primitive_ = 0, polygon_of_triangle_ = nullptr;
  if (is_shape(geometry, hit.object)) {
    material_ = of_file(shape_instance(geometry, hit.object).material);
    return;
  }
  const TriangleMesh& part = geometry.meshes[geometry.mesh_instances.mesh_of(hit.object)].parts[hit.part];
  material_ = of_file(part.material), first_primitive_ = part.first_primitive;
  if (!part.polygon_of_triangle.empty()) polygon_of_triangle_ = part.polygon_of_triangle.data();
}

SurfaceIds surface_ids(const Scene& scene, const HitIds& hit) noexcept { return SurfaceIdReader(scene)(hit); }

namespace {

SurfacePoint shape_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t, float time,
                         bool has_textures) {
  const Affine3d m = world_from_object(scene.geometry, ids.object, time);
  SurfacePoint s = shape_point(scene, ids.object, int(ids.part), m, object_point(m, ray_world, t), has_textures);
  if (!(dot(s.ng_world, s.ng_world) > 0)) s.ng_world = s.ns_world = -ray_world.direction;  // a singular point
  return s;
}

}  // namespace

SurfacePoint surface_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t, float u, float v,
                           float time) noexcept {
  if (is_shape(scene.geometry, ids.object)) return shape_point(scene, ray_world, ids, t, time, true);
  return mesh_point(scene, ids, u, v, time);
}

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

/// The intersectors work in double on the float ray, so only the rounding of the origin has to be cleared.
F shape_offset(const Vec3<D>& p_world) {
  const D largest = larger(absolute(p_world.x), larger(absolute(p_world.y), absolute(p_world.z)));
  return convert<F>(D(D(2 * kUlp) * largest));
}

/// What `shape_point` does, for shapes of one kind, but for texture coordinates. Answers the lanes that are left.
template <class LaneShapes, class ShapeOf>
uint32_t set_points_on(const LaneHits& hits, const Affine3<D>& m, const ShapeOf& shape_of, BasicSurfacePoint<F>& s) {
  const LaneShapes shapes(shape_of);
  const Vec3<D> p = shapes.projected(object_points(hits, inverse(m), m.origin));
  s.p_world = transform_point(m, p);
  s.ng_world = s.ns_world = convert<F>(normalize(outer_normal(m, determinant(m), shapes.normal(p))));
  s.offset = shape_offset(s.p_world);
  return shapes.doubtful(hits);
}

/// The same for one polygon, with its texture coordinates: in all lanes lie one plane's.
void set_points_on(const Polygon& polygon, const Affine3d& m, const LaneHits& hits, BasicSurfacePoint<F>& s) {
  const Vec3d ng = normalize(transform_normal(m, polygon.unit_normal)), center = polygon.center;
  const Affine3<D> all = broadcast(m);
  const Vec3<D> p = nearest_in_plane(polygon, object_points(hits, broadcast(inverse(m)), all.origin));
  s.p_world = transform_point(all, p);
  s.ng_world = s.ns_world = broadcast<F>(Vec3f(ng));
  s.offset = shape_offset(s.p_world);
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

namespace {

/// How much larger everything gets; 0 where the map does not keep shapes as they are.
double similarity_scale(const Affine3d& m) {
  const double squared = dot(m.x, m.x), tolerance = 1e-6 * squared;
  const bool square =
      std::abs(dot(m.x, m.y)) < tolerance && std::abs(dot(m.y, m.z)) < tolerance && std::abs(dot(m.z, m.x)) < tolerance;
  const bool alike = std::abs(dot(m.y, m.y) - squared) < tolerance && std::abs(dot(m.z, m.z) - squared) < tolerance;
  return square && alike ? std::sqrt(squared) : 0;
}

float shape_curvature(const Scene& scene, const HitIds& ids, const SurfacePoint& point, float width, float time) {
  if (const auto* sphere =
          std::get_if<Sphere>(&scene.geometry.shapes[shape_instance(scene.geometry, ids.object).shape]))
    if (const double scale = similarity_scale(world_from_object(scene.geometry, ids.object, time)); scale > 0)
      return float(1 /
                   std::max(sphere->radius * scale, double(width)));  // over more than the ball: as if it were as large
  return float(ShapeSurroundings(scene, ids, point, double(width), time).mean_curvature());
}

template <class N>
N finite_or_0(const N& x) {
  return select(x - x == N(0), x, N(0));
}

}  // namespace

float mean_curvature(const Scene& scene, const HitIds& ids, const SurfacePoint& point, float width,
                     float time) noexcept {
  const Geometry& geometry = scene.geometry;
  if (is_shape(geometry, ids.object)) return finite_or_0(shape_curvature(scene, ids, point, width, time));
  const uint32_t mesh = geometry.mesh_instances.mesh_of(ids.object);
  const TriangleMesh& part = geometry.meshes[mesh].parts[ids.part];
  if (part.normals.empty()) return 0;
  const PosedPart posed(part, ids.part, track_of_mesh(geometry, mesh), time);
  const Corners<float> corners = corners_of(posed, part, {.normals = true}, ids.primitive);
  const Affine3d m = world_from_object(geometry, ids.object, time);
  return finite_or_0(mesh_curvature(corners, m == Affine3d{} ? nullptr : &m));
}

F mean_curvature(const Scene& scene, const LaneHits& hits, const Attributes& has, const BasicSurfacePoint<F>& points,
                 const F& width) noexcept {
  if (is_shape(scene.geometry, hits.ids[0].object)) {
    Vec3Array<D> p;
    Vec3Array<F> ng;
    LaneArray<F> widths, curvature;
    p.store(points.p_world), ng.store(points.ng_world), widths.store(width);
    for (size_t k = 0; k < kWidthOf<F>; ++k) {
      SurfacePoint point;
      point.p_world = p.get(k), point.ng_world = ng.get(k);
      curvature[k] = shape_curvature(scene, hits.ids[k], point, widths[k], 0);
    }
    return finite_or_0(curvature.load());
  }
  if (!has.normals) return F(0);
  const LaneTriangles triangles = lane_triangles(scene, hits, {.normals = true});
  return finite_or_0(mesh_curvature(triangles.corners, triangles.map()));
}

void measure_shape_uvs(const Scene& scene, const HitIds& ids, float width, float time, SurfacePoint& point) noexcept {
  if (!is_shape(scene.geometry, ids.object)) return;
  const float density = ShapeSurroundings(scene, ids, point, double(width), time).uv_per_metre();
  point.uv_per_metre[0] = std::isfinite(density) ? density : 0;
}

SurfacePoint surface_point(const Scene& scene, const Crossing& crossing) noexcept {
  SurfacePoint s;
  if (is_shape(scene.geometry, crossing.object)) {
    const ShapeInstance& placed = shape_instance(scene.geometry, crossing.object);
    s.material = placed.material, s.uv_count = 1;
    const auto uv_on = [&](const auto& shape) {
      const int face = int(crossing.part);
      return texture_coordinates(shape, project(shape, crossing.p_object, face), face);
    };
    if (has_passing_textures(scene.materials[s.material]))
      s.uvs[0] = std::visit(uv_on, scene.geometry.shapes[placed.shape]);
    return s;
  }
  const uint32_t mesh = scene.geometry.mesh_instances.mesh_of(crossing.object);
  const TriangleMesh& part = scene.geometry.meshes[mesh].parts[crossing.part];
  s.material = part.material;
  Attributes has = attributes(part);
  has.normals = has.tangents = has.polygon_normals = false;
  if (!has_passing_textures(scene.materials[s.material])) has.uv_sets = 0;
  const Corners<float> corners = corners_of(PosedPart(part, 0, nullptr, 0), part, has, crossing.primitive);
  interpolate_attributes(corners, has, crossing.u, crossing.v, s);
  return s;
}

}  // namespace alhazen
