// The course's Phong model (ALHAZEN_materials_phong; docs/scene-format.md section 2), at one point or at the points of
// several lanes.
#pragma once

#include "core/power.h"
#include "materials/material.h"

namespace alhazen {

/// Phong's parameters with textures and vertex colour applied.
template <class F>
struct BasicPhongBsdf {
  BasicRgb<F> ambient, diffuse;
  Rgb specular;
  float shininess;
  Rgb reflection, transmission;
  float ior;
  bool fresnel;
};
using PhongBsdf = BasicPhongBsdf<float>;

/// What its textures are looked up with: the model knows no mipmaps.
template <class F>
[[nodiscard]] BasicSurfaceInputs<F> point_inputs(BasicSurfaceInputs<F> inputs) noexcept {
  inputs.uv_per_metre = nullptr;
  return inputs;
}

template <class F = float>
[[nodiscard]] BasicPhongBsdf<F> phong_bsdf(const Material& material, const TextureTable& table,
                                           const BasicSurfaceInputs<F>& inputs) noexcept {
  const PhongParameters& p = material.phong;
  const BasicSurfaceInputs<F> point = point_inputs(inputs);
  const auto textured = [&](const Rgb& factor, const TextureUse& use) {
    return BasicRgb<F>(factor) * inputs.color.rgb * sample(table, use, ColorSpace::srgb, point).rgb;
  };
  return {textured(p.ambient, p.ambient_texture),
          textured(p.diffuse, p.diffuse_texture),
          p.specular,
          p.shininess,
          p.reflection,
          p.transmission,
          p.ior,
          p.fresnel};
}

/// What a light of unit I adds: r_d max(0, n·s) + r_s max(0, r·b)^alpha, the second term only where n·s > 0.
/// n: unit normal turned towards b; s: unit, to the light; b: unit, back along the ray.
template <class F>
[[nodiscard]] BasicRgb<F> reflected_light(const BasicPhongBsdf<F>& bsdf, const Vec3<F>& n, const Vec3<F>& s,
                                          const Vec3<F>& b) noexcept {
  const F ns = dot(n, s);
  const MaskOf<F> faces = ns > F(0);
  BasicRgb<F> light = bsdf.diffuse * ns;
  if (max_component(bsdf.specular) > 0) {
    const F rb = dot(F(F(2) * ns) * n - s, b);
    light += BasicRgb<F>(bsdf.specular) * select(rb > F(0), power(smaller(rb, F(1)), F(bsdf.shininess)), F(0));
  }
  return select(faces, light, BasicRgb<F>(F(0)));
}

/// What the mirror and the refracted ray weigh: reflection and transmission, times the exact F and 1 - F where the
/// material asks for them. `fresnel`: F, 1 past the critical angle; `passes`: whether there is a refracted ray, else
/// its share is mirrored, too.
template <class F>
struct BasicPhongRays {
  BasicRgb<F> mirrored, refracted;
};
using PhongRays = BasicPhongRays<float>;

template <class F>
[[nodiscard]] BasicPhongRays<F> ray_weights(const BasicPhongBsdf<F>& bsdf, std::type_identity_t<F> fresnel,
                                            const MaskOf<F>& passes) noexcept {
  const BasicRgb<F> reflection(bsdf.reflection), transmission(bsdf.transmission);
  if (bsdf.fresnel) return {reflection * fresnel, transmission * (F(1) - fresnel)};
  return {select(passes, reflection, reflection + transmission), select(passes, transmission, BasicRgb<F>(F(0)))};
}

}  // namespace alhazen
