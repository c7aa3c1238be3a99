// glTF's layered surface at one point: the metallic-roughness model (glTF 2.0 specification, appendix B) with
// KHR_materials_ior, _specular, _transmission, _volume, _diffuse_transmission, _anisotropy, _iridescence, under _sheen,
// under _clearcoat.
#pragma once

#include "materials/base_layer.h"

namespace alhazen {

/// The model's parameters with textures and vertex colour applied.
struct MetallicRoughnessBsdf : BaseLayer<float> {
  float diffuse_transmission = 0;  // [0, 1]
  Rgb diffuse_transmission_color{1.0f};
  float anisotropy = 0;  // strength [0, 1]; the frame's t is its direction
  float iridescence = 0, film_ior = 1.3f, film_thickness_nm = 0;
  Rgb sheen_color{0.0f};
  float sheen_roughness = 0;
  float clearcoat = 0, clearcoat_roughness = 0;
};

/// `relative_ior`: of what lies beyond the surface to what lies before it; 0 reflects all.
[[nodiscard]] MetallicRoughnessBsdf metallic_roughness_bsdf(const Material& material, const TextureTable& table,
                                                            const SurfaceInputs& inputs, float relative_ior) noexcept;

/// The same in air.
[[nodiscard]] inline MetallicRoughnessBsdf metallic_roughness_bsdf(const Material& material, const TextureTable& table,
                                                                   const SurfaceInputs& inputs) noexcept {
  return metallic_roughness_bsdf(material, table, inputs, material.ior);
}

/// Where the layers lie: the base with its tangent turned by KHR_materials_anisotropy, the coat by its own normal.
struct LayerFrames {
  ShadingFrame base;
  Vec3f coat_n;

  LayerFrames(const ShadingFrame& frame, const Vec3f& coat) : base(frame), coat_n(coat) {}
  explicit LayerFrames(const Vec3f& n) : base(frame_about(n)), coat_n(n) {}
};

/// BSDF x cosine for one light direction: what a light of unit irradiance (lux on a surface facing it) sends towards b.
/// Normals are unit, on b's side; s: unit, to the light; b: unit, back along the ray. From behind the surface only
/// diffuse transmission shines through.
/// Diffuse is Lambert's, specular GGX with height-correlated Smith and Schlick's Fresnel, mixed as appendix B says;
/// transmission takes its share of the diffuse part.
[[nodiscard]] Rgb reflected_light(const MetallicRoughnessBsdf& bsdf, const LayerFrames& frames, const Vec3f& s,
                                  const Vec3f& b) noexcept;

/// What uniform diffuse light on each side of the surface sends towards the eye, under the layers above.
struct DiffuseAlbedo {
  Rgb front, back;
};
[[nodiscard]] DiffuseAlbedo diffuse_albedo(const MetallicRoughnessBsdf& bsdf, const LayerFrames& frames,
                                           const Vec3f& b) noexcept;

/// Specular reflectance of the base towards b for a smooth surface: metal and dielectric mixed.
[[nodiscard]] Rgb specular_reflectance(const MetallicRoughnessBsdf& bsdf, float cos_theta) noexcept;

/// The share of uniform light that the base's specular lobe reflects towards b, at any roughness.
[[nodiscard]] Rgb specular_albedo(const MetallicRoughnessBsdf& bsdf, float cos_theta) noexcept;

/// What the layers above leave of the base, at most: 1 without sheen and clearcoat.
[[nodiscard]] float layers_transmittance(const MetallicRoughnessBsdf& bsdf, const LayerFrames& frames,
                                         const Vec3f& b) noexcept;

/// The share of light that the coat reflects towards b.
[[nodiscard]] float coat_reflectance(const MetallicRoughnessBsdf& bsdf, const Vec3f& coat_n, const Vec3f& b) noexcept;

}  // namespace alhazen
