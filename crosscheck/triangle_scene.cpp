#include "crosscheck/triangle_scene.h"

#include <cmath>

#include "accel/line_map.h"
#include "accel/shape_hits.h"
#include "accel/traversal_bounds.h"
#include "crosscheck/embree_scene.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {
namespace {

struct PlacedTriangles {
  std::span<const Triangle> triangles;
  Affine3d world_from_object;
};

template <class T>
ObjectLine<T> line_of(const Rayf& ray, const Affine3d& m) {
  const Vec3<T> origin(Vec3d(ray.origin)), direction(Vec3d(ray.direction));
  if (m == Affine3d{}) return {origin, direction, {}, {}};
  if constexpr (std::is_same_v<T, Quad>)
    return object_line(quad_line_map({&m, 1}), origin, direction);
  else
    return object_line(line_map(m), origin, direction);
}

/// Sure of hit or miss, and of the float nearest to t.
template <class T>
bool try_hit(const Triangle& triangle, const ObjectLine<T>& line, std::optional<float>& t) {
  const LineCrossings<T> found = crossings(triangle, line);
  if (found.doubtful) return false;
  const auto& c = found.at[0];
  if (!c.present) return true;
  if (float(c.t - c.error) != float(c.t + c.error)) return false;
  t = float(c.t);
  return true;
}

/// Around the placed triangle, larger by the roundings of the map.
void write_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& placed = *static_cast<const PlacedTriangles*>(args->geometryUserPtr);
  const Bounds3d b = transform_bounds(placed.world_from_object, bounds(placed.triangles[args->primID]));
  const Vec3d& origin = placed.world_from_object.origin;
  const bool exact = placed.world_from_object == Affine3d{};
  const double pad = exact ? 0 : 0x1p-48 * max_component(max(abs(origin), max(abs(b.lower), abs(b.upper))));
  const Vec3d pads{pad, pad, pad};
  const Bounds3f wide = traversal_bounds({b.lower - pads, b.upper + pads});
  *args->bounds_o = {wide.lower.x, wide.lower.y, wide.lower.z, 0, wide.upper.x, wide.upper.y, wide.upper.z, 0};
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& placed = *static_cast<const PlacedTriangles*>(args->geometryUserPtr);
  const Triangle& triangle = placed.triangles[args->primID];
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    embree::reject(args, i);
    const unsigned n = args->N;
    const Rayf one = ray_of(args, i);
    const std::optional<float> t = hit_triangle(triangle, one, placed.world_from_object);
    const bool later = t && *t == one.t_max && RTCHitN_geomID(hit, n, i) != RTC_INVALID_GEOMETRY_ID &&
                       RTCHitN_primID(hit, n, i) < args->primID;
    if (t && !later) embree::accept(args, i, *t);
  }
}

}  // namespace

std::optional<float> hit_triangle(const Triangle& triangle, const Rayf& ray, const Affine3d& m) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3f{}) return {};
  std::optional<float> t;
  const bool by_double = try_hit(triangle, line_of<double>(ray, m), t);
  if (!by_double) ++doubt_counts().quad;
  if (!by_double && !try_hit(triangle, line_of<Quad>(ray, m), t)) {
    ++doubt_counts().exact;
    for (const ExactCrossing& c : exact_crossings(triangle, exact_line({&m, 1}, exact_line(ray)))) t = to_float(c.t);
  }
  return t && *t >= ray.t_min && *t <= ray.t_max ? t : std::nullopt;
}

struct TriangleScene::Impl {
  PlacedTriangles placed;
  EmbreeScene scene{true};

  explicit Impl(const PlacedTriangles& triangles) : placed(triangles) {}
};

TriangleScene::TriangleScene(std::span<const Triangle> triangles, const Affine3d& world_from_object)
    : impl_(std::make_unique<Impl>(PlacedTriangles{triangles, world_from_object})) {
  RTCGeometry g = embree::new_geometry(impl_->scene.device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, unsigned(triangles.size()));
  rtcSetGeometryUserData(g, &impl_->placed);
  rtcSetGeometryBoundsFunction(g, write_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, intersect);
  impl_->scene.attach(g);
  impl_->scene.commit();
}
TriangleScene::~TriangleScene() = default;

void TriangleScene::trace(std::span<const Rayf> rays, const std::function<void(size_t, uint32_t, float)>& found) const {
  impl_->scene.trace(rays, [&](size_t ray, const auto& hit, size_t lane, float t) { found(ray, hit.primID[lane], t); });
}

}  // namespace alhazen::crosscheck
