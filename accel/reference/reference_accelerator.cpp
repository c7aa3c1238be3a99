#include "accel/reference/reference_accelerator.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace alhazen {
namespace {

bool is_nearer(const SurfaceHit& a, const SurfaceHit& b) {
  const auto key = [](const SurfaceHit& h) {
    return std::tuple(h.t, h.crossing.object, h.crossing.part, h.crossing.primitive);
  };
  return key(a) < key(b);
}

void store(const SurfaceHit& hit, HitWave& hits, size_t i) {
  const Crossing& c = hit.crossing;
  hits.t[i] = hit.t, hits.u[i] = c.u, hits.v[i] = c.v;
  hits.object[i] = c.object, hits.part[i] = c.part, hits.primitive[i] = c.primitive;
}

}  // namespace

void ReferenceAccelerator::intersect(const RayWave& rays, HitWave& hits, TestCounts& counts) const {
  hits.resize(rays.size());
  std::vector<SurfaceHit> found;
  for (size_t i = 0; i < rays.size(); ++i) {
    Rayf ray = rays.get(i);
    SurfaceHit nearest{std::numeric_limits<float>::infinity(), {kNone, kNone, kNone, 0, 0, {}}};
    const Visit visit = [&](uint32_t object) {
      found.clear();
      objects_.append_hits(object, ray, found, counts);
      for (const SurfaceHit& hit : found)
        if (is_nearer(hit, nearest)) nearest = hit, ray.t_max = hit.t;
    };
    visit_objects(ray, visit, counts);
    store(nearest, hits, i);
  }
}

void ReferenceAccelerator::transmittance(const RayWave& rays, Lanes<Rgb>& visible, TestCounts& counts) const {
  visible.resize(rays.size());
  std::vector<SurfaceHit> found;
  for (size_t i = 0; i < rays.size(); ++i) {
    Rayf ray = rays.get(i);
    visible[i] = Rgb(1.0f);
    const Visit visit = [&](uint32_t object) {
      if (!(max_component(visible[i]) > 0)) return;
      found.clear();
      objects_.append_hits(object, ray, found, counts);
      for (const SurfaceHit& hit : found) visible[i] *= objects_.transmittance(hit.crossing);
      if (!(max_component(visible[i]) > 0)) ray.t_max = -std::numeric_limits<float>::infinity();
    };
    visit_objects(ray, visit, counts);
  }
}

void BruteForce::visit_objects(const Rayf&, const Visit& visit, TestCounts&) const {
  for (uint32_t object = 0; object < objects_.size(); ++object) visit(object);
}

bool may_meet(const Bounds3d& box, const Rayf& ray) {
  // Wider than the rounding of t to float.
  double enter = double(ray.t_min) - std::abs(double(ray.t_min)) * 0x1p-22;
  double leave = double(ray.t_max) + std::abs(double(ray.t_max)) * 0x1p-22;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = double(ray.origin[axis]), d = double(ray.direction[axis]);
    if (d == 0) {
      if (o < box.lower[axis] || o > box.upper[axis]) return false;
      continue;
    }
    const double a = (box.lower[axis] - o) / d, b = (box.upper[axis] - o) / d;
    const double slack = (std::abs(a) + std::abs(b)) * 1e-14;
    enter = std::max(enter, std::min(a, b) - slack), leave = std::min(leave, std::max(a, b) + slack);
  }
  return enter <= leave && !is_empty(box);
}

}  // namespace alhazen
