#include "crosscheck/scene_judge.h"

#include <algorithm>

#include "crosscheck/verdict.h"

namespace alhazen::crosscheck {
namespace {

double largest(const Vec3d& v) { return max_component(abs(v)); }

/// Whether the line certainly passes by: on different sides of two edges. Plain double with a bound on its errors.
bool passes_by(const Triangle& triangle, const ObjectLine<double>& line) {
  const Vec3d corners[] = {triangle.a - line.origin, triangle.b - line.origin, triangle.c - line.origin};
  const double reach = std::max(largest(corners[0]), std::max(largest(corners[1]), largest(corners[2])));
  const double speed = largest(line.direction), off = largest(line.origin_error) + reach * 0x1p-51;
  const double error =
      reach * (largest(line.direction_error) * reach + 2 * speed * off) * 7 + speed * reach * reach * 0x1p-48;
  bool left = false, right = false;
  for (int k = 0; k < 3; ++k) {
    const double side = dot(line.direction, cross(corners[k], corners[(k + 1) % 3]));
    left = left || side > error, right = right || side < -error;
  }
  return left && right;
}

/// How far a ray must be followed to see everything within `kTiedFloats` of `t`.
double just_behind(float t) { return double(t) + std::abs(double(t)) * 0x1p-18; }

}  // namespace

bool is_first(const SceneTruth& truth, const SurfaceId& id, double floats) {
  return std::any_of(truth.surfaces.begin(), truth.surfaces.end(),
                     [&](const SurfaceAt& s) { return s.id == id && floats_between(s.t, truth.nearest.t) <= floats; });
}

SceneJudge::SceneJudge(const SceneBoxes& boxes, const NativeScene* native) : boxes_(&boxes), native_(native) {
  for (uint32_t k = 0; k < boxes.object_count(); ++k) objects_.push_back(object_of(k));
}

SceneJudge::Object SceneJudge::object_of(uint32_t number) const {
  const bool shape = is_shape(boxes_->geometry(), number);
  if (!native_)
    return {boxes_->world_from_object(number),
            shape ? std::make_unique<Judge>(boxes_->subject({number, 0, 0})) : nullptr};
  const auto& held = native_->object(number);
  if (!held) return {};
  return {held->world_from_object, shape ? std::make_unique<Judge>(*held->shape) : nullptr};
}

Judgement SceneJudge::judge(const SurfaceId& id, const Triangle* triangle, const Rayf& ray) const {
  const Object& object = objects_[id.object];
  return triangle ? Judge({*triangle, object.world_from_object}).closest(ray) : object.judge->closest(ray);
}

SceneTruth SceneJudge::closest(const Rayf& ray) const {
  SceneTruth truth;
  double t_limit = double(ray.t_max);
  boxes_->visit(ray, t_limit, [&](const SurfaceId& id, const Triangle* triangle, const ObjectLine<double>& line) {
    if (native_ && !native_->answers_for(id.object, ray)) return void(truth.complete = false);
    if (triangle && passes_by(*triangle, line)) return;
    const Judgement j = judge(id, triangle, ray);
    if (!j.hit) return;
    if (!truth.nearest.hit || j.t < truth.nearest.t) {
      truth.nearest = j, t_limit = just_behind(j.t);
      truth.surfaces.insert(truth.surfaces.begin(), {id, j.t});
    } else {
      truth.surfaces.push_back({id, j.t});
    }
  });
  std::erase_if(truth.surfaces, [&](const SurfaceAt& s) { return floats_between(s.t, truth.nearest.t) > kTiedFloats; });
  return truth;
}

}  // namespace alhazen::crosscheck
