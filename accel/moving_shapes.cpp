#include "accel/moving_shapes.h"

#include <map>

#include "accel/packet.h"
#include "accel/posed.h"
#include "accel/shape_bounds.h"
#include "accel/shape_hits.h"
#include "accel/user_geometry.h"
#include "accel/wave_query.h"

namespace alhazen {
namespace {

const MovingShapes& shapes_of(const void* data) { return *static_cast<const MovingShapes*>(data); }

Bounds3d bounds_at(const MovingShapes::Member& member, size_t pose) {
  return conservative_bounds((*member.places)[pose], object_bounds(*member.shape));
}

/// The image of a box under a map that is linear in time lies within what is linear between its boxes at the poses.
void bound(const RTCBoundsFunctionArguments* args) {
  const MovingShapes& shapes = shapes_of(args->geometryUserPtr);
  write_bounds(args, bounds_at(shapes.members[args->primID], args->timeStep));
}

/// Calls visit(member, hit, crossing) for what a lane's ray hits at its time, the nearest first, until it returns true.
template <class Arguments, class Visit>
void for_each_hit(const Arguments* args, unsigned i, const Visit& visit) {
  const MovingShapes& shapes = shapes_of(args->geometryUserPtr);
  const MovingShapes::Member& member = shapes.members[args->primID];
  const RayRows rays = rows_of(args);
  const Rayf ray = rays.ray(i);
  const Affine3d world_from_object = at_time(*member.places, rays.time()[i]);
  if (!is_invertible(world_from_object)) return;  // on its way through a mirror image of itself
  const PlacedShape placed{line_map(world_from_object), &world_from_object, member.shape};
  thread_local std::vector<ShapeHit> hits;
  hits.clear();
  append_hits(placed, ray, hits);
  for (const ShapeHit& hit : hits) {
    const Crossing crossing{member.object, hit.face, 0, 0, 0, object_point(placed.object_from_world, ray, hit.t)};
    if (visit(member, hit, crossing)) return;
  }
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  const SurfaceFilter& filter = shapes_of(args->geometryUserPtr).filter;
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    embree::reject(args, i);  // until a crossing is found to count
    for_each_hit(args, i, [&](const MovingShapes::Member& member, const ShapeHit& hit, const Crossing& crossing) {
      if (member.opacity == Opacity::cutout && !filter.is_present(filter.data, crossing)) return false;
      take(args, i, hit.t, float(hit.face), 0);
      return true;
    });
  }
}

void occlude(const RTCOccludedFunctionNArguments* args) {
  const SurfaceFilter& filter = shapes_of(args->geometryUserPtr).filter;
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    embree::reject(args, i);
    Rgb& visible = embree::query_of<WaveQuery>(args).visible[RTCRayN_id(args->ray, args->N, i)];
    for_each_hit(args, i, [&](const MovingShapes::Member& member, const ShapeHit&, const Crossing& crossing) {
      visible *= member.opacity == Opacity::opaque ? Rgb(0.0f) : filter.transmittance(filter.data, crossing);
      if (max_component(visible) > 0) return false;
      embree::accept(args, i);
      return true;
    });
  }
}

}  // namespace

std::vector<std::unique_ptr<MovingShapes>> moving_shapes(const Geometry& geometry, const SurfaceFilter& filter) {
  std::map<size_t, std::unique_ptr<MovingShapes>> by_poses;
  for (uint32_t i = 0; i < geometry.shape_instances.size(); ++i) {
    const auto object = uint32_t(geometry.mesh_instances.size()) + i;
    const Track<Affine3d>* track = track_of_object(geometry, object);
    if (!track) continue;
    const ShapeInstance& instance = geometry.shape_instances[i];
    const MovingShapes::Member member{&geometry.shapes[instance.shape], track,
                                      filter.opacity.empty() ? Opacity::opaque : filter.opacity[instance.material],
                                      object};
    if (is_empty(object_bounds(*member.shape))) continue;  // what has no surface is never hit
    for (size_t pose = 0; pose < track->size(); ++pose) check_reach(geometry, object, bounds_at(member, pose));
    auto& shapes = by_poses[track->size()];
    if (!shapes) shapes = std::make_unique<MovingShapes>(MovingShapes{filter, track->size(), {}});
    shapes->members.push_back(member);
  }
  std::vector<std::unique_ptr<MovingShapes>> all;
  for (auto& [poses, shapes] : by_poses) all.push_back(std::move(shapes));
  return all;
}

RTCGeometry new_moving_geometry(RTCDevice device, const MovingShapes& shapes) {
  return new_user_geometry(device, {.primitives = shapes.members.size(),
                                    .time_steps = shapes.poses,
                                    .data = &shapes,
                                    .bounds = bound,
                                    .intersect = intersect,
                                    .occluded = occlude});
}

}  // namespace alhazen
