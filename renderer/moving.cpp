#include "renderer/moving.h"

#include <algorithm>

namespace alhazen {
namespace {

template <class T>
T mix_numbers(T a, T b, float f) {
  return a * (1 - T(f)) + b * T(f);
}

}  // namespace

Light mix(const Light& a, const Light& b, float f) {
  Light light;
  light.kind = a.kind, light.attenuated = a.attenuated;
  light.intensity = lerp(a.intensity, b.intensity, f);
  light.p_world = mix(a.p_world, b.p_world, f);
  light.direction_world = normalize(mix(a.direction_world, b.direction_world, f));
  light.range = mix_numbers(a.range, b.range, f);
  light.cos_inner = mix_numbers(a.cos_inner, b.cos_inner, f);
  light.cos_outer = mix_numbers(a.cos_outer, b.cos_outer, f);
  return light;
}

Camera mix(const Camera& a, const Camera& b, float f) {
  Camera camera;
  camera.kind = a.kind;
  camera.yfov = mix_numbers(a.yfov, b.yfov, f), camera.ymag = mix_numbers(a.ymag, b.ymag, f);
  camera.world_from_camera = mix(a.world_from_camera, b.world_from_camera, f);
  return camera;
}

bool is_moving(const Scene& scene, const Camera& camera) {
  const auto moves = [](const Light& light) { return !light.track.empty(); };
  return !scene.geometry.motion.empty() || !camera.track.empty() ||
         std::any_of(scene.lights.begin(), scene.lights.end(), moves);
}

}  // namespace alhazen
