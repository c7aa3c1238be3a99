#include "crosscheck/triangle_scene.h"

#include <cmath>

#include "accel/line_map.h"
#include "accel/shape_hits.h"
#include "crosscheck/embree_scene.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {
namespace {

template <class T>
ObjectLine<T> line_of(const Rayf& ray) {
  return {Vec3<T>(Vec3d(ray.origin)), Vec3<T>(Vec3d(ray.direction)), {}, {}};
}

/// Sure of hit or miss, and of the float nearest to t.
template <class T>
bool try_hit(const Triangle& triangle, const Rayf& ray, std::optional<float>& t) {
  const LineCrossings<T> found = crossings(triangle, line_of<T>(ray));
  if (found.doubtful) return false;
  const auto& c = found.at[0];
  if (!c.present) return true;
  if (float(c.t - c.error) != float(c.t + c.error)) return false;
  t = float(c.t);
  return true;
}

void write_bounds(const RTCBoundsFunctionArguments* args) {
  const Bounds3d b = bounds(static_cast<const Triangle*>(args->geometryUserPtr)[args->primID]);
  const auto down = [](double x) { return std::nextafter(float(x), -HUGE_VALF); };
  const auto up = [](double x) { return std::nextafter(float(x), HUGE_VALF); };
  *args->bounds_o = {down(b.lower.x), down(b.lower.y), down(b.lower.z), 0,
                     up(b.upper.x),   up(b.upper.y),   up(b.upper.z),   0};
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  const Triangle& triangle = static_cast<const Triangle*>(args->geometryUserPtr)[args->primID];
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    embree::reject(args, i);
    const unsigned n = args->N;
    const Rayf one{{RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i)},
                   {RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i)},
                   RTCRayN_tnear(ray, n, i),
                   RTCRayN_tfar(ray, n, i)};
    const std::optional<float> t = hit_triangle(triangle, one);
    const bool later = t && *t == one.t_max && RTCHitN_geomID(hit, n, i) != RTC_INVALID_GEOMETRY_ID &&
                       RTCHitN_primID(hit, n, i) < args->primID;
    if (t && !later) embree::accept(args, i, *t);
  }
}

}  // namespace

std::optional<float> hit_triangle(const Triangle& triangle, const Rayf& ray) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3f{}) return {};
  std::optional<float> t;
  const bool by_double = try_hit<double>(triangle, ray, t);
  if (!by_double) ++doubt_counts().quad;
  if (!by_double && !try_hit<Quad>(triangle, ray, t)) {
    ++doubt_counts().exact;
    for (const ExactCrossing& c : exact_crossings(triangle, exact_line(ray))) t = to_float(c.t);
  }
  return t && *t >= ray.t_min && *t <= ray.t_max ? t : std::nullopt;
}

struct TriangleScene::Impl {
  EmbreeScene scene{true};
};

TriangleScene::TriangleScene(std::span<const Triangle> triangles) : impl_(std::make_unique<Impl>()) {
  RTCGeometry g = embree::new_geometry(impl_->scene.device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, unsigned(triangles.size()));
  rtcSetGeometryUserData(g, const_cast<Triangle*>(triangles.data()));
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
