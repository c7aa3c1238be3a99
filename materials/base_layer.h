// The base of glTF's layered surface: the metallic-roughness model (glTF 2.0 specification, appendix B) with
// KHR_materials_ior and _specular, at one point or at the points of several lanes.
#pragma once

#include "materials/fresnel.h"
#include "materials/material.h"
#include "materials/microfacet.h"

namespace alhazen {

/// Parameters with textures and vertex colour applied.
template <class F>
struct BaseLayer {
  BasicRgb<F> base_color;     // without alpha
  F metallic;                 // [0, 1]
  F roughness;                // perceptual, [0, 1]; alpha = roughness²
  BasicRgb<F> dielectric_f0;  // of the dielectric layer: ior, specular and specularColor
  F dielectric_f90;
  F transmission;  // [0, 1]
  F occlusion;     // [0, 1], strength applied
};

/// `relative_ior`: of what lies beyond the surface to what lies before it; 0 reflects all.
template <class F = float>
[[nodiscard]] BaseLayer<F> base_layer(const Material& material, const TextureTable& table,
                                      const BasicSurfaceInputs<F>& inputs, float relative_ior) noexcept {
  const auto linear = [&](const TextureUse& use) { return sample(table, use, ColorSpace::linear, inputs); };
  const auto srgb = [&](const TextureUse& use) { return sample(table, use, ColorSpace::srgb, inputs).rgb; };
  const BasicRgb<F> metal_rough = linear(material.metallic_roughness_texture).rgb;
  const F specular = unit_clamped(F(material.specular * linear(material.specular_texture).a));
  const float root = relative_ior == 0 ? 1 : (relative_ior - 1) / (relative_ior + 1);
  const BasicRgb<F> f0 = BasicRgb<F>(root * root * material.specular_color) * srgb(material.specular_color_texture);
  BaseLayer<F> base;
  base.base_color = BasicRgb<F>(material.base_color.rgb) * inputs.color.rgb * srgb(material.base_color_texture);
  base.metallic = unit_clamped(F(material.metallic * metal_rough.b));
  base.roughness = unit_clamped(F(material.roughness * metal_rough.g));
  base.dielectric_f0 = BasicRgb<F>(unit_clamped(f0.r), unit_clamped(f0.g), unit_clamped(f0.b)) * specular;
  base.dielectric_f90 = specular;
  base.transmission = unit_clamped(F(material.transmission * linear(material.transmission_texture).rgb.r));
  base.occlusion =
      unit_clamped(F(F(1) + material.occlusion_strength * (linear(material.occlusion_texture).rgb.r - F(1))));
  return base;
}

/// Schlick's reflectances of the two surfaces that the model mixes.
template <class F>
struct BaseFresnel {
  BasicRgb<F> dielectric, metal;
};
template <class F>
[[nodiscard]] BaseFresnel<F> base_fresnel(const BaseLayer<F>& base, std::type_identity_t<F> cos_theta) noexcept {
  return {fresnel_schlick(base.dielectric_f0, base.dielectric_f90, cos_theta),
          fresnel_schlick(base.base_color, F(1), cos_theta)};
}

/// BSDF x cosine n·s > 0: Lambert's `diffuse` under what the dielectric reflects, and both surfaces' `specular` lobe.
template <class F>
[[nodiscard]] BasicRgb<F> base_light(const BaseLayer<F>& base, const BaseFresnel<F>& fresnel,
                                     const BasicRgb<F>& diffuse, std::type_identity_t<F> specular,
                                     std::type_identity_t<F> ns) noexcept {
  const BasicRgb<F> dielectric = diffuse * (F(1) - max_component(fresnel.dielectric)) + fresnel.dielectric * specular;
  return lerp(dielectric, fresnel.metal * specular, base.metallic) * ns;
}

/// How much of a mirror reflection a single mirror ray stands for: 1 at roughness 0, falling smoothly to 0 at 0.5 and
/// above.
template <class F>
[[nodiscard]] F mirror_share(F roughness) noexcept {
  const F t = unit_clamped(F(F(2) * roughness));
  return F(1) - t * t * (F(3) - F(2) * t);
}

}  // namespace alhazen
