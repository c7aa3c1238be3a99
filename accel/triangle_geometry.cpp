#include "accel/triangle_geometry.h"

#include "accel/instance_geometry.h"
#include "accel/packet.h"
#include "accel/posed.h"
#include "accel/shape_hits.h"
#include "accel/user_geometry.h"
#include "accel/wave_query.h"

namespace alhazen {
namespace {

struct Hit {
  float t, u, v;
};

Triangle triangle_of(const TriangleGroup& group, uint32_t primitive) {
  const auto& corner = group.part.triangles[primitive];
  const auto& p = group.part.positions;
  return {Vec3d(p[corner[0]]), Vec3d(p[corner[1]]), Vec3d(p[corner[2]])};
}

/// Triangles that share a vertex share it at every time.
Triangle triangle_at(const TriangleGroup& group, uint32_t primitive, float time) {
  const auto& corner = group.part.triangles[primitive];
  const PosedPart part(group.part, group.part_index, group.track, time);
  return {Vec3d(part.position(corner[0])), Vec3d(part.position(corner[1])), Vec3d(part.position(corner[2]))};
}

bool has_area(const Triangle& t) {
  const Vec3d n = cross(t.b - t.a, t.c - t.a);
  if (!(n == Vec3d{})) return true;
  const Vec3<Rational> a = exact(t.a), exact_n = cross(exact(t.b) - a, exact(t.c) - a);
  return sgn(exact_n.x) != 0 || sgn(exact_n.y) != 0 || sgn(exact_n.z) != 0;
}

/// Empty for what is never hit.
void bound(const RTCBoundsFunctionArguments* args) {
  const auto& group = *static_cast<const TriangleGroup*>(args->geometryUserPtr);
  const auto& corner = group.part.triangles[args->primID];
  const auto& p = group.track ? (*group.track)[args->timeStep][group.part_index].positions : group.part.positions;
  const Triangle t{Vec3d(p[corner[0]]), Vec3d(p[corner[1]]), Vec3d(p[corner[2]])};
  Bounds3d box;
  // Without area at one pose, a triangle may have some at another.
  if (is_finite(t.a) && is_finite(t.b) && is_finite(t.c) && (group.track || has_area(t)))
    extend(box, t.a), extend(box, t.b), extend(box, t.c);
  write_bounds(args, box);
}

const LineMap<double>& identity_map() {
  static const LineMap<double> map = line_map(Affine3d{});
  return map;
}

/// Where double leaves a doubt.
std::optional<Hit> hit_the_long_way(const Triangle& triangle, const Rayf& ray) {
  thread_local std::vector<ShapeHit> hits;
  hits.clear();
  append_hits(triangle, identity_map(), Affine3d{}, ray, hits);
  if (hits.empty()) return {};
  const Vec2d uv = weights_at(triangle, Vec3d(ray.origin) + Vec3d(ray.direction) * double(hits[0].t));
  return Hit{hits[0].t, float(uv.x), float(uv.y)};
}

template <class T>
ObjectLine<T> exact_line_of(const Vec3<T>& origin, const Vec3<T>& direction) {
  const Vec3<T> none{T(0), T(0), T(0)};
  return {origin, direction, none, none};
}

std::optional<Hit> hit_of(const Triangle& triangle, const Rayf& ray) {
  const TriangleCrossing<double> found = crossing(triangle, exact_line_of(Vec3d(ray.origin), Vec3d(ray.direction)));
  const Nearest<double> first = nearest(crossings(found), double(ray.t_min), double(ray.t_max));
  if (first.doubtful) return hit_the_long_way(triangle, ray);
  if (!first.hit) return {};
  return Hit{float(first.t), float(found.u), float(found.v)};
}

/// Calls visit(lane, hit) for those of the packet's active lanes that hit the triangle in their range.
template <class Visit>
[[gnu::flatten]] void for_each_hit(const Triangle& triangle, const RayRows& rays, unsigned first, uint32_t bits,
                                   const Visit& visit) {
  const PacketLanes lanes(rays, first);
  const TriangleCrossing<DoubleLanes> found = crossing(triangle, exact_line_of(lanes.origin, lanes.direction));
  const Nearest<DoubleLanes> nearest_hit = nearest(crossings(found), lanes.t_min, lanes.t_max);
  const uint32_t doubtful = lane_bits(nearest_hit.doubtful) & bits,
                 sure = lane_bits(nearest_hit.hit) & bits & ~doubtful;
  const LaneFloats t = floats_of(nearest_hit.t), u = floats_of(found.u), v = floats_of(found.v);
  for_each_bit(sure, [&](unsigned i) { visit(first + i, Hit{t[i], u[i], v[i]}); });
  for_each_bit(doubtful, [&](unsigned i) {
    if (const auto hit = hit_the_long_way(triangle, rays.ray(first + i))) visit(first + i, *hit);
  });
}

template <class Arguments, class Visit>
void for_each_hit_in_motion(const Arguments* args, const TriangleGroup& group, const Visit& visit) {
  const RayRows rays = rows_of(args);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    embree::reject(args, i);  // until a hit counts
    if (const auto hit = hit_of(triangle_at(group, args->primID, rays.time()[i]), rays.ray(i))) visit(group, i, *hit);
  }
}

template <class Arguments, class Visit>
void for_each_hit(const Arguments* args, const Visit& visit) {
  const auto& group = *static_cast<const TriangleGroup*>(args->geometryUserPtr);
  if (group.track) return for_each_hit_in_motion(args, group, visit);
  const Triangle triangle = triangle_of(group, args->primID);
  const RayRows rays = rows_of(args);
  const uint32_t lanes = with_width(rays.width, [&](auto n) {
    return active_lanes<n>(args->valid) &
           lanes_that_may_cross<n>(triangle, load_origins<n>(rays), load_directions<n>(rays));
  });
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) embree::reject(args, i);  // until a hit counts
  for_lanes(
      lanes, rays.width,
      [&](unsigned i) {
        if (const auto hit = hit_of(triangle, rays.ray(i))) visit(group, i, *hit);
      },
      [&](unsigned first, uint32_t bits) {
        for_each_hit(triangle, rays, first, bits, [&](unsigned i, const Hit& hit) { visit(group, i, hit); });
      });
}

template <class Arguments>
Crossing crossing_of(const Arguments* args, const TriangleGroup& group, const Hit& hit) {
  const uint32_t instance = args->context->instID[0];
  const uint32_t object = instance == RTC_INVALID_GEOMETRY_ID ? group.object
                          : instance & kInGroup               ? instance & ~kInGroup
                                                : embree::query_of<WaveQuery>(args).object_of_instance[instance];
  return {object, group.part_index, args->primID, hit.u, hit.v, {}};
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  for_each_hit(args, [&](const TriangleGroup& group, unsigned i, const Hit& hit) {
    const SurfaceFilter& filter = group.filter;
    if (group.opacity != Opacity::cutout || filter.is_present(filter.data, crossing_of(args, group, hit)))
      take(args, i, hit.t, hit.u, hit.v);
  });
}

void occlude(const RTCOccludedFunctionNArguments* args) {
  for_each_hit(args, [&](const TriangleGroup& group, unsigned i, const Hit& hit) {
    if (group.opacity == Opacity::opaque) return embree::accept(args, i);
    Rgb& visible = embree::query_of<WaveQuery>(args).visible[RTCRayN_id(args->ray, args->N, i)];
    visible *= group.filter.transmittance(group.filter.data, crossing_of(args, group, hit));
    if (!(max_component(visible) > 0)) embree::accept(args, i);
  });
}

}  // namespace

RTCGeometry new_triangle_geometry(RTCDevice device, const TriangleGroup& group) {
  return new_user_geometry(device, {.primitives = group.part.triangles.size(),
                                    .time_steps = group.track ? group.track->size() : 1,
                                    .data = &group,
                                    .bounds = bound,
                                    .intersect = intersect,
                                    .occluded = occlude});
}

}  // namespace alhazen
