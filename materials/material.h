// Materials as scenes describe them, and their values at one point of a surface.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "core/opacity.h"
#include "core/vec.h"
#include "materials/texture.h"

namespace alhazen {

enum class AlphaMode : uint8_t { opaque, mask, blend };
enum class ShadingModel : uint8_t { metallic_roughness, phong, unlit, measured };

/// ALHAZEN_materials_phong: the course's model. Symbols as in docs/scene-format.md.
struct PhongParameters {
  Rgb ambient{0.8f}, diffuse{0.8f}, specular{0.0f};
  float shininess = 32;
  Rgb reflection{0.0f}, transmission{0.0f};
  float ior = 1.5f;
  bool fresnel = false;
  bool takes_part = false;  // in the rules of overlapping bodies: `priority` is given
  int priority = 0;
  TextureUse ambient_texture, diffuse_texture;
};

/// ALHAZEN_materials_measured.
struct MeasuredUse {
  uint32_t brdf = kNone;  // index into Scene::measured
  float scale = 1;        // of the BRDF
};

// The layers and lobes of KHR_materials_*: every default is that of the extension where it is absent.

struct Clearcoat {
  float factor = 0, roughness = 0;
  TextureUse texture;            // linear: R
  TextureUse roughness_texture;  // linear: G
  TextureUse normal_texture;     // linear, tangent space; without one the coat has the surface's own normal
  float normal_scale = 1;
};

struct Sheen {
  Rgb color{0.0f};
  TextureUse color_texture;  // sRGB
  float roughness = 0;
  TextureUse roughness_texture;  // linear: A
};

struct Anisotropy {
  float strength = 0, rotation = 0;  // rotation: radians from the tangent towards the bitangent
  TextureUse texture;                // linear: RG direction, B strength
};

struct Iridescence {
  float factor = 0, ior = 1.3f;
  TextureUse texture;  // linear: R
  float thickness_min_nm = 100, thickness_max_nm = 400;
  TextureUse thickness_texture;  // linear: G; without one the film has its largest thickness
};

struct DiffuseTransmission {
  float factor = 0;
  TextureUse texture;  // linear: A
  Rgb color{1.0f};
  TextureUse color_texture;  // sRGB
};

/// What is inside of a body; without thickness a surface is a thin wall with nothing behind it.
struct Volume {
  float thickness = 0;           // metres in the mesh's space: an estimate, for shadows
  TextureUse thickness_texture;  // linear: G
  float attenuation_distance = std::numeric_limits<float>::infinity();  // metres
  Rgb attenuation_color{1.0f};  // what is left of white light after that distance
  float dispersion = 0;         // KHR_materials_dispersion: 20 over the Abbe number

  [[nodiscard]] bool is_body() const { return thickness > 0; }
};

/// A glTF material. Factors are linear; every default is the specification's.
struct Material {
  std::string name;
  ShadingModel model = ShadingModel::metallic_roughness;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;  // recorded; surfaces are shaded on both sides whatever it says

  Rgba base_color{Rgb{1.0f}, 1.0f};
  TextureUse base_color_texture;  // sRGB
  float metallic = 1, roughness = 1;
  TextureUse metallic_roughness_texture;  // linear: G roughness, B metallic
  TextureUse normal_texture;              // linear, tangent space
  float normal_scale = 1;
  TextureUse occlusion_texture;  // linear: R
  float occlusion_strength = 1;
  Rgb emissive{0.0f};           // emissiveFactor x KHR_materials_emissive_strength
  TextureUse emissive_texture;  // sRGB

  float ior = 1.5f;             // KHR_materials_ior; 0 means infinite: F0 = 1 before specular
  float specular = 1;           // KHR_materials_specular
  TextureUse specular_texture;  // linear: A
  Rgb specular_color{1.0f};
  TextureUse specular_color_texture;  // sRGB
  float transmission = 0;             // KHR_materials_transmission
  TextureUse transmission_texture;    // linear: R
  Clearcoat clearcoat;
  Sheen sheen;
  Anisotropy anisotropy;
  Iridescence iridescence;
  DiffuseTransmission diffuse_transmission;
  Volume volume;

  PhongParameters phong;  // read where model is phong
  MeasuredUse measured;   // read where model is measured
};

/// Coverage of the surface at a point: 1 for OPAQUE, 0 or 1 for MASK, else the base colour's alpha in [0, 1].
/// Base-colour factor x texture x vertex colour, as glTF says.
template <class F = float>
[[nodiscard]] F coverage(const Material& material, const TextureTable& table,
                         const BasicSurfaceInputs<F>& inputs) noexcept;

/// The share of light that passes straight through the surface: 1 in a hole of MASK; (1 - a) + a t for BLEND; else t,
/// where t is Phong's transmissionFactor, or glTF's transmission x base colour; into or out of a body also what half of
/// its thickness lets through.
[[nodiscard]] Rgb straight_transmittance(const Material& material, const TextureTable& table,
                                         const SurfaceInputs& inputs) noexcept;

/// Whether textures say which light passes at a point: those that `coverage` and `straight_transmittance` look up.
[[nodiscard]] inline bool has_passing_textures(const Material& material) noexcept {
  return material.base_color_texture || material.transmission_texture || material.volume.thickness_texture;
}

/// cutout for MASK; transparent for BLEND and for a transmission that may exceed 0; else opaque.
[[nodiscard]] Opacity opacity(const Material& material) noexcept;

/// The light that a surface sends out by itself.
template <class F = float>
[[nodiscard]] BasicRgb<F> emission(const Material& material, const TextureTable& table,
                                   const BasicSurfaceInputs<F>& inputs) noexcept;

/// A normal texture's direction in tangent space (x along the tangent, z along the normal), unit length, x and y
/// scaled; (0, 0, 1) without a texture or where it decodes to nothing usable.
template <class F = float>
[[nodiscard]] Vec3<F> tangent_space_normal(const TextureUse& texture, float scale, const TextureTable& table,
                                           const BasicSurfaceInputs<F>& inputs) noexcept;

/// Where anisotropic highlights are drawn out: the angle in radians from the tangent towards the bitangent.
[[nodiscard]] float anisotropy_angle(const Material& material, const TextureTable& table,
                                     const SurfaceInputs& inputs) noexcept;

/// How a body dims light, by metre: -ln(colour) / distance; 0 where it does not.
[[nodiscard]] Rgb attenuation_per_metre(const Volume& volume) noexcept;

}  // namespace alhazen
