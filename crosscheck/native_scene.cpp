#include "crosscheck/native_scene.h"

#include <algorithm>

#include "crosscheck/native_geometry.h"

namespace alhazen::crosscheck {
namespace {

/// Of a mesh any triangle does: it is the map that rounding may change.
Subject given_subject(const SceneBoxes& boxes, uint32_t object) {
  const Geometry& geometry = boxes.geometry();
  if (is_shape(geometry, object)) return boxes.subject({object, 0, 0});
  return {.surface = Triangle{}, .world_from_object = geometry.mesh_instances[object].world_from_object};
}

}  // namespace

const SceneAnswer& nearer(const SceneAnswer& a, const SceneAnswer& b) {
  if (!a.answer.hit || !b.answer.hit) return a.answer.hit ? a : b;
  return b.answer.t < a.answer.t ? b : a;
}

struct NativeScene::Impl {
  EmbreeScene scene{true};
  std::vector<uint32_t> object_of_geometry;  // by top-level geometry number
  std::vector<Affine3d> object_from_world;   // by object
};

NativeScene::NativeScene(const SceneBoxes& boxes) : impl_(std::make_unique<Impl>()) {
  for (uint32_t object = 0; object < boxes.object_count(); ++object) {
    std::optional<NativeSubject> native = native_subject(given_subject(boxes, object));
    RTCGeometry g = nullptr;
    if (native && is_shape(boxes.geometry(), object)) {
      g = new_native_geometry(impl_->scene.device(), native->subject.surface);
      if (!g) native.reset();
    }
    impl_->object_from_world.push_back(native ? inverse(native->subject.world_from_object) : Affine3d{});
    if (g) {
      impl_->object_of_geometry.push_back(object);
      impl_->scene.attach_instance(g, Affine3f(native->subject.world_from_object), true);
    }
    subjects_.push_back(std::move(native));
  }
  impl_->scene.commit();
}
NativeScene::~NativeScene() = default;

bool NativeScene::is_rounded() const {
  return std::any_of(subjects_.begin(), subjects_.end(), [](const auto& s) { return s && s->rounded; });
}

bool NativeScene::answers_for(uint32_t object, const Rayf& ray) const {
  const auto& native = subjects_[object];
  return native && native_is_for(native->subject.surface, impl_->object_from_world[object], ray);
}

void NativeScene::answer(std::span<const Rayf> rays, std::vector<SceneAnswer>& answers) const {
  answers.assign(rays.size(), {});
  if (impl_->object_of_geometry.empty()) return;
  impl_->scene.trace(rays, [&](size_t k, const auto& hit, size_t lane, float t) {
    const uint32_t object = impl_->object_of_geometry[hit.instID[0][lane]];
    answers[k] = {native_answer(subjects_[object]->subject.surface, hit, lane, t), {object, 0, 0}};
  });
}

}  // namespace alhazen::crosscheck
