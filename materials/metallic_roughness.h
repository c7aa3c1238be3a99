// glTF's metallic-roughness model at one point (glTF 2.0 specification, appendix B), with KHR_materials_ior, _specular
// and _transmission.
#pragma once

#include "materials/material.h"

namespace alhazen {

/// The model's parameters with textures and vertex colour applied.
struct MetallicRoughnessBsdf {
  Rgb base_color;     // without alpha
  float metallic;     // [0, 1]
  float roughness;    // perceptual, [0, 1]; alpha = roughness²
  Rgb dielectric_f0;  // of the dielectric layer: ior, specular and specularColor
  float dielectric_f90;
  float transmission;  // [0, 1]
  float occlusion;     // [0, 1], strength applied
  float ior;
};

[[nodiscard]] MetallicRoughnessBsdf metallic_roughness_bsdf(const Material& material, const TextureTable& table,
                                                            const SurfaceInputs& inputs) noexcept;

/// BRDF x cosine for one light direction: what a light of unit irradiance (lux on a surface facing it) sends towards b.
/// n: unit, on b's side; s: unit, to the light; b: unit, back along the ray. 0 where n·s <= 0.
/// Diffuse is Lambert's, specular GGX with height-correlated Smith and Schlick's Fresnel, mixed as appendix B says;
/// transmission takes its share of the diffuse part. alpha is at least 1e-3 so that punctual highlights stay finite.
[[nodiscard]] Rgb reflected_light(const MetallicRoughnessBsdf& bsdf, const Vec3f& n, const Vec3f& s,
                                  const Vec3f& b) noexcept;

/// The part that ambient light sees: base colour x (1 - metallic) x (1 - transmission).
[[nodiscard]] Rgb diffuse_albedo(const MetallicRoughnessBsdf& bsdf) noexcept;

/// Fresnel reflectance towards b of the smooth surface: metal and dielectric mixed.
[[nodiscard]] Rgb specular_reflectance(const MetallicRoughnessBsdf& bsdf, float cos_theta) noexcept;

/// How much of a mirror reflection a single mirror ray stands for: 1 at roughness 0, falling smoothly to 0 at 0.5 and
/// above.
[[nodiscard]] float mirror_share(float roughness) noexcept;

}  // namespace alhazen
