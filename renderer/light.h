// What a light sends to a point.
#pragma once

#include <limits>

#include "core/lane_vec.h"
#include "renderer/scene.h"

namespace alhazen {

/// At one point, or at those of several lanes.
template <class F>
struct ArrivingLight {
  BasicRgb<F> radiance;  // lux on a surface that faces the light; with ALHAZEN_lights "none", its intensity
  Vec3<F> to_light;      // unit
  F distance;            // metres; infinite for directional lights
};

/// Colour x intensity x attenuation (KHR_lights_punctual's formulas). Nothing arrives at the light itself.
template <class F>
[[nodiscard]] ArrivingLight<F> light_at(const Light& light, const Vec3<DoubleOf<F>>& p_world) noexcept {
  using D = DoubleOf<F>;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (light.kind == Light::Kind::directional)
    return {BasicRgb<F>(light.intensity), broadcast<F>(Vec3f(-light.direction_world)), F(kInfinity)};
  const Vec3<F> segment = convert<F>(Vec3<D>(D(light.p_world.x), D(light.p_world.y), D(light.p_world.z)) - p_world);
  const F squared = dot(segment, segment), distance = square_root(squared), reciprocal = F(1) / distance;
  const MaskOf<F> apart = squared > F(0);
  const Vec3<F> to_light = segment * reciprocal;
  F factor(1);
  if (light.attenuated) {
    factor = reciprocal * reciprocal;
    if (light.range > 0) {
      const F share = distance / F(light.range), share2 = share * share;
      factor = factor * clamped(F(F(1) - share2 * share2), 0, 1);
    }
  }
  if (light.kind == Light::Kind::spot) {
    const F cosine = -dot(broadcast<F>(Vec3f(light.direction_world)), to_light);
    const float scale = 1 / std::max(0.001f, light.cos_inner - light.cos_outer);
    const F angular = clamped(F((cosine - F(light.cos_outer)) * F(scale)), 0, 1);
    factor = factor * (angular * angular);
  }
  const BasicRgb<F> arriving = BasicRgb<F>(light.intensity) * factor;
  return {select(apart, arriving, BasicRgb<F>(F(0))), to_light, distance};
}

}  // namespace alhazen
