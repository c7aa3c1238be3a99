#include <cmath>

#include "accel/accelerated_scene.h"
#include "accel/line_map.h"
#include "crosscheck/party.h"
#include "crosscheck/triangle_scene.h"

namespace alhazen::crosscheck {
namespace {

/// Shapes, as the renderer asks for them.
class ShapeParty final : public Party {
 public:
  ShapeParty(Shape shape, const Affine3d& world_from_object)
      : geometry_(geometry_of(std::move(shape), world_from_object)),
        scene_(geometry_, {}, {}),
        world_from_object_(world_from_object) {}

  void answer(std::span<const Rayf> rays, std::vector<Answer>& answers) override {
    load(rays);
    scene_.intersect(wave_, Coherence::incoherent, hits_);
    answers.assign(rays.size(), {});
    for (size_t k = 0; k < rays.size(); ++k)
      if (hits_.object[k] != kNone) answers[k] = answer_of(rays[k], hits_.t[k], int(hits_.part[k]));
  }

  bool answer_shadows(std::span<const Rayf> rays, std::vector<bool>& blocked) override {
    load(rays);
    Lanes<Rgb> visible;
    scene_.transmittance(wave_, Coherence::incoherent, visible);
    blocked.resize(rays.size());
    for (size_t k = 0; k < rays.size(); ++k) blocked[k] = max_component(visible[k]) == 0;
    return true;
  }

 private:
  void load(std::span<const Rayf> rays) {
    wave_.resize(rays.size());
    for (size_t k = 0; k < rays.size(); ++k) wave_.set(k, rays[k]);
  }

  static Geometry geometry_of(Shape shape, const Affine3d& m) {
    Geometry geometry;
    geometry.shapes.push_back(std::move(shape));
    geometry.shape_instances.push_back({0, 0, 0, m});
    return geometry;
  }

  [[nodiscard]] Answer answer_of(const Rayf& ray, float t, int face) const {
    const Vec3d n = normal_at_hit(geometry_.shapes.front(), world_from_object_, ray, t, face);
    return {.hit = true, .t = t, .face = face, .normal_object = n};
  }

  Geometry geometry_;
  AcceleratedScene scene_;
  Affine3d world_from_object_;
  RayWave wave_;
  HitWave hits_;
};

class TriangleParty final : public Party {
 public:
  TriangleParty(const Triangle& triangle, const Affine3d& world_from_object)
      : scene_({&triangle, 1}, world_from_object), normal_(normal(triangle, {}, 0)) {}

  void answer(std::span<const Rayf> rays, std::vector<Answer>& answers) override {
    answers.assign(rays.size(), {});
    scene_.trace(rays, [&](size_t k, uint32_t, float t) {
      answers[k] = {.hit = true, .t = t, .face = kWallFace, .normal_object = normal_};
    });
  }

 private:
  TriangleScene scene_;
  Vec3d normal_;
};

}  // namespace

Vec3d normal_at_hit(const Shape& shape, const Affine3d& world_from_object, const Rayf& ray, float t, int face) {
  const Vec3d p_near = object_point(world_from_object, ray, t);
  return std::visit([&](const auto& s) { return normal(s, project(s, p_near, face), face); }, shape);
}

std::unique_ptr<Party> custom_party(const Subject& subject) {
  return std::visit(
      [&](const auto& s) -> std::unique_ptr<Party> {
        if constexpr (std::is_same_v<std::decay_t<decltype(s)>, Triangle>)
          return std::make_unique<TriangleParty>(s, subject.world_from_object);
        else
          return std::make_unique<ShapeParty>(Shape(s), subject.world_from_object);
      },
      subject.surface);
}

}  // namespace alhazen::crosscheck
