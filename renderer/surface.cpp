#include "renderer/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "accel/line_map.h"
#include "accel/posed.h"
#include "materials/microfacet.h"

namespace alhazen {
namespace {

constexpr double kUlp = 0x1p-24;  // half the spacing of floats, relative

/// What a triangle brings from the corners of its part, as far as the part has it.
template <class F>
struct Corners {
  std::array<Vec3<F>, 3> p_object, n_object, t_object;
  F handedness;  // of the first tangent
  std::array<std::array<Vec2<F>, kMaxUvSets>, 3> uvs;
  std::array<BasicRgba<F>, 3> colors;
};

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
template <class D>
D plane_error(const Vec3<D>& a, const Vec3<D>& b, const Vec3<D>& c, const D& twice_area) {
  const D ab = length(b - a), bc = length(c - b), ca = length(a - c);
  const D low = smaller(ab, bc), high = larger(ab, bc);
  const D shortest = smaller(low, ca), middle = larger(low, smaller(high, ca)), longest = larger(high, ca);
  return longest * smaller(D(D(8 * kUlp) * shortest * middle), twice_area);
}

/// Position, normals and their errors. `m`: to the world, or null for a part that lies there; `roundings`: of the
/// position, in units of kUlp.
template <class F>
void place(const Corners<F>& corners, const Attributes& has, const F& u, const F& v, const Affine3<DoubleOf<F>>* m,
           const DoubleOf<F>& roundings, BasicSurfacePoint<F>& s) {
  using D = DoubleOf<F>;
  const auto vertex = [&](size_t k) { return convert<D>(corners.p_object[k]); };
  const auto in_world = [&](const Vec3<D>& p) { return m ? transform_point(*m, p) : p; };
  const std::array<Vec3<D>, 3> p{in_world(vertex(0)), in_world(vertex(1)), in_world(vertex(2))};
  s.p_world = interpolated(p, convert<D>(u), convert<D>(v));
  const Vec3<D> across = cross(p[1] - p[0], p[2] - p[0]);
  const D twice_area = length(across);
  const D stretch = m ? determinant(*m) : D(1);
  const Vec3<D> ng = normalize(across);
  s.ng_world = s.ns_world = convert<F>(select(stretch < D(0), -ng, ng));

  const auto size_of = [](const Vec3<D>& x) { return larger(absolute(x.x), larger(absolute(x.y), absolute(x.z))); };
  D size = size_of(s.p_world), error;
  if (m) {
    const Vec3<D> a = vertex(0), b = vertex(1), c = vertex(2);
    size = size + size_of(m->origin);
    error = plane_error(a, b, c, length(cross(b - a, c - a))) * absolute(stretch);
  } else {
    error = plane_error(p[0], p[1], p[2], twice_area);
  }
  s.offset = convert<F>(D(D(kUlp) * roundings * size + error / twice_area));

  if (has.normals) {
    const Vec3<D> n = convert<D>(interpolated(corners.n_object, u, v));
    const Vec3<D> n_world = normalize(m ? outer_normal(*m, stretch, n) : n);
    const D squared = dot(n_world, n_world);
    const auto usable = squared > D(0) && squared - squared == D(0);
    s.ns_world = select(convert_mask<F>(usable), convert<F>(n_world), s.ns_world);
  }
  if (has.tangents) {
    const Vec3<D> t = convert<D>(interpolated(corners.t_object, u, v));
    s.tangent_world = convert<F>(normalize(m ? transform_vector(*m, t) : t));
    s.bitangent_sign = select(convert_mask<F>(stretch < D(0)), F(-corners.handedness), corners.handedness);
  }
}

/// Texture coordinates and colour, and how fast the coordinates go over the triangle: the root of the ratio of the
/// areas.
template <class F>
void interpolate_attributes(const Corners<F>& corners, const Attributes& has, const F& u, const F& v,
                            BasicSurfacePoint<F>& s) {
  s.uv_count = int(has.uv_sets);
  for (size_t k = 0; k < has.uv_sets; ++k)
    s.uvs[k] = interpolated(std::array{corners.uvs[0][k], corners.uvs[1][k], corners.uvs[2][k]}, u, v);
  if (!has.colors) return;
  const auto& c = corners.colors;
  s.color = {interpolated(std::array{c[0].rgb, c[1].rgb, c[2].rgb}, u, v),
             interpolated(std::array{c[0].a, c[1].a, c[2].a}, u, v)};
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
    const Vec2<F> a = corners.uvs[0][k], b = corners.uvs[1][k], c = corners.uvs[2][k];
    const F uv_area = absolute(F((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)));
    s.uv_per_metre[k] = select(area > F(0), square_root(F(uv_area / area)), F(0));
  }
}

Corners<float> corners_of(const PosedPart& posed, const TriangleMesh& part, const Attributes& has, uint32_t triangle) {
  const std::array<uint32_t, 3>& corner = part.triangles[triangle];
  Corners<float> c;
  for (size_t k = 0; k < 3; ++k) {
    c.p_object[k] = posed.position(corner[k]);
    if (has.normals) c.n_object[k] = posed.normal(corner[k]);
    if (has.tangents) {
      const Vec4f t = posed.tangent(corner[k]);
      c.t_object[k] = {t.x, t.y, t.z};
      if (k == 0) c.handedness = t.w;
    }
    for (size_t i = 0; i < has.uv_sets; ++i) c.uvs[k][i] = part.uvs[i][corner[k]];
    if (has.colors) {
      const Vec4f& color = part.colors[corner[k]];
      c.colors[k] = {{color.x, color.y, color.z}, color.w};
    }
  }
  return c;
}

SurfacePoint mesh_point(const Scene& scene, const HitIds& ids, float u, float v, float time) {
  const Geometry& geometry = scene.geometry;
  const MeshInstance& instance = geometry.mesh_instances[ids.object];
  const TriangleMesh& part = geometry.meshes[instance.mesh].parts[ids.part];
  const PosedPart posed(part, ids.part, track_of_mesh(geometry, instance.mesh), time);
  const Affine3d m = world_from_object(geometry, ids.object, time);
  const Affine3d* map = m == Affine3d{} ? nullptr : &m;
  const Attributes has = attributes(part);
  const Corners<float> corners = corners_of(posed, part, has, ids.primitive);
  SurfacePoint s;
  s.material = part.material;
  interpolate_attributes(corners, has, u, v, s);
  measure_uvs(corners, has, map, s);
  // Rounding of the position, of an instance's ray transform, and of the traversal's plane; of both poses in motion.
  const bool moves = track_of_object(geometry, ids.object) || track_of_mesh(geometry, instance.mesh);
  place(corners, has, u, v, map, moves ? 64.0 : map ? 16.0 : 4.0, s);
  if (part.normals.empty() && !part.polygon_normals.empty()) {
    const Vec3f n = posed.polygon_normal(polygon_of(part, ids.primitive));
    const Vec3d n_world = normalize(transform_normal(m, Vec3d(n)));
    if (dot(n_world, n_world) > 0) s.ns_world = Vec3f(n_world);
  }
  return s;
}

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
        s.bitangent_sign = determinant(m) < 0 ? 1.0f : -1.0f;  // v runs down
        s.uvs[0] = texture_coordinates(shape, p, face);
      },
      scene.geometry.shapes[placed.shape]);
  s.uv_count = 1;
  // The intersectors work in double on the float ray, so only the rounding of the origin has to be cleared.
  s.offset = float(2 * kUlp * max_component(abs(s.p_world)));
  return s;
}

/// Half the divergence of the normals, which are linear between the corners.
double mesh_curvature(const Scene& scene, const HitIds& ids, float time) {
  const Geometry& geometry = scene.geometry;
  const uint32_t mesh = geometry.mesh_instances[ids.object].mesh;
  const TriangleMesh& part = geometry.meshes[mesh].parts[ids.part];
  if (part.normals.empty()) return 0;
  const PosedPart posed(part, ids.part, track_of_mesh(geometry, mesh), time);
  const Affine3d m = world_from_object(geometry, ids.object, time);
  const auto& corner = part.triangles[ids.primitive];
  std::array<Vec3d, 3> p, n;
  for (size_t k = 0; k < 3; ++k) {
    p[k] = transform_point(m, Vec3d(posed.position(corner[k])));
    n[k] = normalize(transform_normal(m, Vec3d(posed.normal(corner[k]))));
  }
  const Vec3d e1 = p[1] - p[0], e2 = p[2] - p[0], across = cross(e1, e2);
  // Per unit of each edge, times the vector that is 1 along it and 0 along the other.
  const double divergence = dot(n[1] - n[0], cross(e2, across)) + dot(n[2] - n[0], cross(across, e1));
  return divergence / (2 * dot(across, across));
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
        step_(std::max(width, 1e-6 * max_component(abs(point.p_world)))) {  // well above the rounding of double
    const ShadingFrame frame = frame_about(point.ng_world);
    sides_ = {Vec3d(frame.t), Vec3d(frame.b)};
  }

  /// From how far the normal leans outward at the steps, put back on the surface.
  [[nodiscard]] double mean_curvature() const {
    const Vec3d n = normal_near(p_world_);
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
  double step_;
  std::array<Vec3d, 2> sides_;
};

}  // namespace

SurfaceIds surface_ids(const Scene& scene, const HitIds& hit) noexcept {
  const Geometry& geometry = scene.geometry;
  // The default material is the last one, and none of the file's.
  const auto of_file = [&](uint32_t material) { return material + 1 == scene.materials.size() ? kNone : material; };
  const uint32_t node = node_of(geometry, hit.object);
  if (is_shape(geometry, hit.object)) return {node, 0, of_file(shape_instance(geometry, hit.object).material)};
  const TriangleMesh& part = geometry.meshes[geometry.mesh_instances[hit.object].mesh].parts[hit.part];
  return {node, part.first_primitive + polygon_of(part, hit.primitive), of_file(part.material)};
}

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

/// Corners of a triangle in each lane, on their way from memory.
struct CornerArrays {
  std::array<Vec3Array<F>, 3> p, n, t;
  LaneArray<F> handedness;
  std::array<std::array<std::array<LaneArray<F>, 2>, kMaxUvSets>, 3> uvs;
  std::array<RgbArray<F>, 3> colors;
  std::array<LaneArray<F>, 3> alphas;

  void set(size_t lane, const TriangleMesh& part, const Attributes& has, uint32_t triangle) {
    const std::array<uint32_t, 3>& corner = part.triangles[triangle];
    for (size_t k = 0; k < 3; ++k) {
      p[k].set(lane, part.positions[corner[k]]);
      if (has.normals) n[k].set(lane, part.normals[corner[k]]);
      if (has.tangents) {
        const Vec4f& tangent = part.tangents[corner[k]];
        t[k].set(lane, {tangent.x, tangent.y, tangent.z});
        if (k == 0) handedness[lane] = tangent.w;
      }
      for (size_t i = 0; i < has.uv_sets; ++i) {
        const Vec2f& uv = part.uvs[i][corner[k]];
        uvs[k][i][0][lane] = uv.x, uvs[k][i][1][lane] = uv.y;
      }
      if (has.colors) {
        const Vec4f& color = part.colors[corner[k]];
        colors[k].set(lane, {color.x, color.y, color.z}), alphas[k][lane] = color.w;
      }
    }
  }

  [[nodiscard]] Corners<F> load(const Attributes& has) const {
    Corners<F> c;
    for (size_t k = 0; k < 3; ++k) {
      c.p_object[k] = p[k].load();
      if (has.normals) c.n_object[k] = n[k].load();
      if (has.tangents) c.t_object[k] = t[k].load();
      for (size_t i = 0; i < has.uv_sets; ++i) c.uvs[k][i] = {uvs[k][i][0].load(), uvs[k][i][1].load()};
      if (has.colors) c.colors[k] = {colors[k].load(), alphas[k].load()};
    }
    if (has.tangents) c.handedness = handedness.load();
    return c;
  }
};

struct AffineArrays {
  std::array<Vec3Array<D>, 4> columns;

  void set(size_t lane, const Affine3d& m) {
    columns[0].set(lane, m.x), columns[1].set(lane, m.y), columns[2].set(lane, m.z), columns[3].set(lane, m.origin);
  }
  [[nodiscard]] Affine3<D> load() const {
    return {columns[0].load(), columns[1].load(), columns[2].load(), columns[3].load()};
  }
};

void set_mesh_points(const Scene& scene, const LaneHits& hits, const Attributes& has, bool measure,
                     BasicSurfacePoint<F>& s) {
  const Geometry& geometry = scene.geometry;
  CornerArrays arrays;
  AffineArrays maps;
  LaneArray<D> roundings;
  bool all_in_world = true;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    const HitIds& ids = hits.ids[k];
    const MeshInstance& instance = geometry.mesh_instances[ids.object];
    arrays.set(k, geometry.meshes[instance.mesh].parts[ids.part], has, ids.primitive);
    maps.set(k, instance.world_from_object);
    const bool in_world = instance.world_from_object == Affine3d{};
    roundings[k] = in_world ? 4 : 16;
    all_in_world = all_in_world && in_world;
  }
  const Corners<F> corners = arrays.load(has);
  const F u = hits.u.load(), v = hits.v.load();
  Affine3<D> map;
  if (!all_in_world) map = maps.load();
  interpolate_attributes(corners, has, u, v, s);
  if (measure) measure_uvs(corners, has, all_in_world ? nullptr : &map, s);
  place(corners, has, u, v, all_in_world ? nullptr : &map, roundings.load(), s);
}

void set_shape_points(const Scene& scene, const LaneHits& hits, bool has_textures, BasicSurfacePoint<F>& s) {
  Vec3Array<D> p;
  LaneArray<F> offset, bitangent_sign, u, v;
  Vec3Array<F> ng, ns, tangent;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
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

float mean_curvature(const Scene& scene, const HitIds& ids, const SurfacePoint& point, float width,
                     float time) noexcept {
  const double curvature = is_shape(scene.geometry, ids.object)
                               ? ShapeSurroundings(scene, ids, point, double(width), time).mean_curvature()
                               : mesh_curvature(scene, ids, time);
  return std::isfinite(curvature) ? float(curvature) : 0;
}

void measure_shape_uvs(const Scene& scene, const HitIds& ids, float width, float time, SurfacePoint& point) noexcept {
  if (!is_shape(scene.geometry, ids.object)) return;
  const float density = ShapeSurroundings(scene, ids, point, double(width), time).uv_per_metre();
  point.uv_per_metre[0] = std::isfinite(density) ? density : 0;
}

SurfacePoint surface_point(const Scene& scene, const Crossing& crossing) noexcept {
  if (is_shape(scene.geometry, crossing.object))
    return shape_point(scene, crossing.object, int(crossing.part),
                       shape_instance(scene.geometry, crossing.object).world_from_object, crossing.p_object);
  const MeshInstance& instance = scene.geometry.mesh_instances[crossing.object];
  const TriangleMesh& part = scene.geometry.meshes[instance.mesh].parts[crossing.part];
  SurfacePoint s;
  s.material = part.material;
  Attributes has = attributes(part);
  has.normals = has.tangents = false;
  const Corners<float> corners = corners_of(PosedPart(part, 0, nullptr, 0), part, has, crossing.primitive);
  interpolate_attributes(corners, has, crossing.u, crossing.v, s);
  return s;
}

}  // namespace alhazen
