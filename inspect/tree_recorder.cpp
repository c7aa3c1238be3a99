#include "inspect/tree_recorder.h"

#include <algorithm>

namespace alhazen {
namespace {

TreeRay started(const Rayf& ray, const Path& path) {
  TreeRay r;
  r.kind = path.kind, r.depth = path.depth, r.weight = path.weight, r.ray = ray;
  r.media.assign(path.media.material.begin(), path.media.material.begin() + path.media.count);
  return r;
}

RayEnd end_of(SpawnOutcome outcome) {
  switch (outcome) {
    case SpawnOutcome::depth_limit:
      return RayEnd::depth_limit;
    case SpawnOutcome::weight_limit:
      return RayEnd::weight_limit;
    case SpawnOutcome::traced:
      break;
  }
  return RayEnd::missed;  // until it hits something
}

Rgb ratio(const Rgb& a, const Rgb& b) {
  const auto of = [](float x, float y) { return y > 0 ? x / y : 0.0f; };
  return {of(a.r, b.r), of(a.g, b.g), of(a.b, b.b)};
}

}  // namespace

void TreeRecorder::begin_sample(int sample, const PathWave& camera_rays, const Lanes<float>& times) {
  followed_.begin(camera_rays.size(), kNone);
  if (sample != sample_) return;
  if (times.size() > 0) time_ = times[pixel_];
  for (size_t i = 0; i < camera_rays.size(); ++i) {
    if (camera_rays.paths.pixel[i] != pixel_) continue;
    followed_.pending(i) = uint32_t(rays_.size());
    rays_.push_back(started(camera_rays.rays.get(i), camera_rays.paths[i]));
  }
}

void TreeRecorder::hit(const ShadedHit& hit) {
  if (ray_ == kNone) return;
  TreeRay& ray = rays_[ray_];
  const SurfacePoint& s = hit.surface;
  ray.end = RayEnd::shaded;
  ray.hit = TreeHit{.object = hit.ids.object,
                    .ids = surface_ids(scene_, hit.ids),
                    .material = s.material,
                    .distance = hit.t * length(ray.ray.direction),
                    .p_world = s.p_world,
                    .ng_world = s.ng_world,
                    .ns_world = hit.n,
                    .uv = s.uv_count > 0 ? std::optional(s.uvs[0]) : std::nullopt,
                    .enters = hit.enters,
                    .alpha = hit.alpha,
                    .arriving = hit.arriving};
}

void TreeRecorder::pass_unnoticed() {
  if (ray_ != kNone) rays_[ray_].end = RayEnd::unnoticed;
}

void TreeRecorder::part(const Interface& interface) {
  if (ray_ != kNone) rays_[ray_].interface = interface;
}

void TreeRecorder::add(LightTerm term, const Rgb& light) {
  if (ray_ == kNone || light == Rgb(0.0f)) return;
  rays_[ray_].terms.push_back({term, {order_++, light}});
}

void TreeRecorder::uncover(float share) {
  if (ray_ != kNone) rays_[ray_].uncovered += share;
}

void TreeRecorder::spawn(const Rayf& ray, const Path& path, Bounce bounce, SpawnOutcome outcome) {
  uint32_t index = kNone;
  if (ray_ != kNone) {
    index = uint32_t(rays_.size());
    TreeRay spawned = started(ray, path);
    spawned.parent = ray_, spawned.end = end_of(outcome);
    spawned.total = path.kind == RayKind::mirror && rays_[ray_].interface && rays_[ray_].interface->total;
    rays_.push_back(std::move(spawned));
  }
  if (outcome == SpawnOutcome::traced) followed_.spawn(bounce, index);
}

void TreeRecorder::ask(const LightQuery& query) {
  if (ray_ == kNone) return asked_.push_back({kNone, 0});
  std::vector<TreeLight>& lights = rays_[ray_].lights;
  asked_.push_back({ray_, uint32_t(lights.size())});
  lights.push_back({.light = query.light,
                    .shadow = query.shadow,
                    .distance = query.distance,
                    .arriving = query.arriving,
                    .attenuation = ratio(query.arriving, scene_.lights[query.light].intensity),
                    .diffuse = query.diffuse,
                    .specular = query.specular});
}

void TreeRecorder::answer(size_t i, const Rgb& visible, const Rgb& light) {
  if (asked_[i].ray == kNone) return;
  TreeLight& asked = rays_[asked_[i].ray].lights[asked_[i].light];
  asked.visible = visible, asked.addend = {order_++, light};
}

}  // namespace alhazen
