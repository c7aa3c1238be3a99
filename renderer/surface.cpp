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

/// The next larger float; of the largest, infinity. Finite numbers and -infinity only.
float next_up(float x) {
  const auto bits = std::bit_cast<uint32_t>(x);
  if (x == 0) return std::numeric_limits<float>::denorm_min();
  return std::bit_cast<float>(x > 0 ? bits + 1 : bits - 1);
}

void interpolate_attributes(const TriangleMesh& part, const std::array<uint32_t, 3>& corner, float u, float v,
                            SurfacePoint& s) {
  const float w = 1 - u - v;
  s.uv_count = int(part.uvs.size());
  for (int k = 0; k < s.uv_count; ++k) {
    const auto& uv = part.uvs[size_t(k)];
    s.uvs[size_t(k)] = uv[corner[0]] * w + uv[corner[1]] * u + uv[corner[2]] * v;
  }
  if (!part.colors.empty()) {
    const Vec4f &a = part.colors[corner[0]], &b = part.colors[corner[1]], &c = part.colors[corner[2]];
    s.color = {{w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y, w * a.z + u * b.z + v * c.z},
               w * a.w + u * b.w + v * c.w};
  }
}

/// How fast texture coordinates go over a triangle of that area: the root of the ratio of the areas.
void measure_uvs(const TriangleMesh& part, const std::array<uint32_t, 3>& corner, double area, SurfacePoint& s) {
  s.has_uv_per_metre = area > 0;
  for (size_t k = 0; s.has_uv_per_metre && k < part.uvs.size(); ++k) {
    const Vec2f a = part.uvs[k][corner[0]], b = part.uvs[k][corner[1]], c = part.uvs[k][corner[2]];
    const float uv_area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    s.uv_per_metre[k] = std::sqrt(uv_area / float(area));
  }
}

/// Traversal computes a triangle's normal in floats in object space, as a cross product of its edges, and with it the
/// plane's distance from a ray that starts up to the longest edge away from a vertex: wrong by this over twice the
/// area. For needles that is many roundings; for a triangle of no area, more than its size would hide nothing any more.
double plane_error(const PosedPart& part, const std::array<uint32_t, 3>& corner) {
  const Vec3d a(part.position(corner[0])), b(part.position(corner[1])), c(part.position(corner[2]));
  std::array<double, 3> edges = {length(b - a), length(c - b), length(a - c)};
  std::ranges::sort(edges);
  return edges[2] * std::min(8 * kUlp * edges[0] * edges[1], length(cross(b - a, c - a)));
}

SurfacePoint mesh_point(const Scene& scene, const HitIds& ids, float u, float v, float time) {
  const Geometry& geometry = scene.geometry;
  const MeshInstance& instance = geometry.mesh_instances[ids.object];
  const TriangleMesh& part = geometry.meshes[instance.mesh].parts[ids.part];
  const PosedPart posed(part, ids.part, track_of_mesh(geometry, instance.mesh), time);
  const Affine3d m = world_from_object(geometry, ids.object, time);
  const auto& corner = part.triangles[ids.primitive];
  SurfacePoint s;
  s.material = part.material;
  interpolate_attributes(part, corner, u, v, s);

  const bool baked = m == Affine3d{};
  const auto vertex = [&](size_t k) {
    const Vec3d p_object(posed.position(corner[k]));
    return baked ? p_object : transform_point(m, p_object);
  };
  const Vec3d p0 = vertex(0), p1 = vertex(1), p2 = vertex(2);
  s.p_world = p0 * (1.0 - u - v) + p1 * double(u) + p2 * double(v);
  const Vec3d twice_area = cross(p1 - p0, p2 - p0);
  measure_uvs(part, corner, length(twice_area), s);
  Vec3d ng = normalize(twice_area);
  const double stretch = baked ? 1 : determinant(m);
  if (stretch < 0) ng = -ng;
  s.ng_world = s.ns_world = Vec3f(ng);
  if (part.normals.empty() && !part.polygon_normals.empty()) {
    const Vec3f n = posed.polygon_normal(polygon_of(part, ids.primitive));
    const Vec3d n_world = normalize(transform_normal(m, Vec3d(n)));
    if (dot(n_world, n_world) > 0) s.ns_world = Vec3f(n_world);
  }
  // Rounding of the position, of an instance's ray transform, and of the traversal's plane; of both poses in motion.
  const bool moves = track_of_object(geometry, ids.object) || track_of_mesh(geometry, instance.mesh);
  const double roundings = moves ? 64 : baked ? 4 : 16;
  s.offset = float(kUlp * roundings * (max_component(abs(s.p_world)) + max_component(abs(m.origin))) +
                   plane_error(posed, corner) * std::abs(stretch) / length(twice_area));

  const float w = 1 - u - v;
  if (!part.normals.empty()) {
    const Vec3f n = posed.normal(corner[0]) * w + posed.normal(corner[1]) * u + posed.normal(corner[2]) * v;
    const Vec3d n_world = normalize(baked ? Vec3d(n) : transform_normal(m, Vec3d(n)));
    if (is_finite(n_world) && dot(n_world, n_world) > 0) s.ns_world = Vec3f(n_world);
  }
  if (!part.tangents.empty()) {
    const Vec4f a = posed.tangent(corner[0]), b = posed.tangent(corner[1]), c = posed.tangent(corner[2]);
    const Vec3f t{w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y, w * a.z + u * b.z + v * c.z};
    s.tangent_world = Vec3f(normalize(baked ? Vec3d(t) : transform_vector(m, Vec3d(t))));
    s.bitangent_sign = stretch < 0 ? -a.w : a.w;
  }
  return s;
}

/// `m`: from the shape's space to the world.
SurfacePoint shape_point(const Scene& scene, uint32_t object, int face, const Affine3d& m, const Vec3d& p_near_object) {
  const ShapeInstance& placed = shape_instance(scene.geometry, object);
  SurfacePoint s;
  s.material = placed.material;
  std::visit(
      [&](const auto& shape) {
        const Vec3d p = project(shape, p_near_object, face);
        s.p_world = transform_point(m, p);
        s.ng_world = s.ns_world = Vec3f(normalize(transform_normal(m, normal(shape, p, face))));
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

SurfacePoint surface_point(const Scene& scene, const Rayf& ray_world, const HitIds& ids, float t, float u, float v,
                           float time) noexcept {
  if (!is_shape(scene.geometry, ids.object)) return mesh_point(scene, ids, u, v, time);
  const Affine3d m = world_from_object(scene.geometry, ids.object, time);
  SurfacePoint s = shape_point(scene, ids.object, int(ids.part), m, object_point(m, ray_world, t));
  if (!(dot(s.ng_world, s.ng_world) > 0)) s.ng_world = s.ns_world = -ray_world.direction;  // a singular point
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
  point.uv_per_metre[0] = ShapeSurroundings(scene, ids, point, double(width), time).uv_per_metre();
  point.has_uv_per_metre = std::isfinite(point.uv_per_metre[0]);
}

SurfacePoint surface_point(const Scene& scene, const Crossing& crossing) noexcept {
  if (is_shape(scene.geometry, crossing.object))
    return shape_point(scene, crossing.object, int(crossing.part),
                       shape_instance(scene.geometry, crossing.object).world_from_object, crossing.p_object);
  const MeshInstance& instance = scene.geometry.mesh_instances[crossing.object];
  const TriangleMesh& part = scene.geometry.meshes[instance.mesh].parts[crossing.part];
  SurfacePoint s;
  s.material = part.material;
  interpolate_attributes(part, part.triangles[crossing.primitive], crossing.u, crossing.v, s);
  return s;
}

Vec3f spawn_origin(const SurfacePoint& point, const Vec3f& direction) noexcept {
  const Vec3d n = Vec3d(point.ng_world) * (dot(point.ng_world, direction) < 0 ? -1.0 : 1.0);
  const Vec3d p = point.p_world + n * double(point.offset);
  const auto away = [](double x, double toward) {
    return toward > 0 ? next_up(float(x)) : toward < 0 ? -next_up(-float(x)) : float(x);
  };
  return {away(p.x, n.x), away(p.y, n.y), away(p.z, n.z)};
}

}  // namespace alhazen
