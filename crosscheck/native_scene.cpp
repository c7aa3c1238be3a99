#include "crosscheck/native_scene.h"

#include <map>

#include "crosscheck/native_geometry.h"

namespace alhazen::crosscheck {
namespace {

/// Of a mesh any triangle does: it is the map that rounding may change.
Subject given_subject(const SceneBoxes& boxes, uint32_t object) {
  if (is_shape(boxes.geometry(), object)) return boxes.subject({object, 0, 0});
  return {.surface = Triangle{}, .world_from_object = boxes.world_from_object(object)};
}

}  // namespace

const SceneAnswer& nearer(const SceneAnswer& a, const SceneAnswer& b) {
  if (!a.answer.hit || !b.answer.hit) return a.answer.hit ? a : b;
  return b.answer.t < a.answer.t ? b : a;
}

struct NativeScene::Impl {
  EmbreeScene scene{true};
  std::vector<uint32_t> object_of_geometry;     // by top-level geometry number
  std::map<uint32_t, RTCScene> scene_of_shape;  // null: Embree has no such geometry

  RTCScene shape_scene(uint32_t shape, const Surface& surface) {
    const auto [found, is_new] = scene_of_shape.try_emplace(shape, nullptr);
    if (!is_new) return found->second;
    if (RTCGeometry g = new_native_geometry(scene.device(), surface)) found->second = scene.new_inner(g, true);
    return found->second;
  }
};

NativeScene::NativeScene(const SceneBoxes& boxes) : impl_(std::make_unique<Impl>()) {
  for (uint32_t number = 0; number < boxes.object_count(); ++number) add_object(boxes, number);
  impl_->scene.commit();
}
NativeScene::~NativeScene() = default;

void NativeScene::add_object(const SceneBoxes& boxes, uint32_t number) {
  std::optional<Object>& object = objects_.emplace_back();
  const std::optional<NativeSubject> native = native_subject(given_subject(boxes, number));
  if (!native) return void(rounded_ = true);
  const Affine3d& m = native->subject.world_from_object;
  rounded_ = rounded_ || native->rounded;
  if (!is_shape(boxes.geometry(), number)) return void(object = Object{m, inverse(m), nullptr});
  RTCScene scene = impl_->shape_scene(shape_instance(boxes.geometry(), number).shape, native->subject.surface);
  if (!scene) return;
  object = Object{m, inverse(m), std::make_unique<Subject>(native->subject)};
  impl_->object_of_geometry.push_back(number);
  impl_->scene.attach_instance(scene, Affine3f(m));
}

bool NativeScene::answers_for(uint32_t number, const Rayf& ray) const {
  static const Surface triangle = Triangle{};
  const std::optional<Object>& object = objects_[number];
  return object && native_is_for(object->shape ? object->shape->surface : triangle, object->object_from_world, ray);
}

void NativeScene::answer(std::span<const Rayf> rays, std::vector<SceneAnswer>& answers) const {
  answers.assign(rays.size(), {});
  if (impl_->object_of_geometry.empty()) return;
  impl_->scene.trace(rays, [&](size_t k, const auto& hit, size_t lane, float t) {
    const uint32_t number = impl_->object_of_geometry[hit.instID[0][lane]];
    answers[k] = {native_answer(objects_[number]->shape->surface, hit, lane, t), {number, 0, 0}};
  });
}

}  // namespace alhazen::crosscheck
