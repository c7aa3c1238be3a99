#include "materials/material.h"

namespace alhazen {
namespace {

template <class F>
BasicRgba<F> base_color(const Material& material, const TextureTable& table, const BasicSurfaceInputs<F>& inputs) {
  const BasicRgba<F> texel = sample(table, material.base_color_texture, ColorSpace::srgb, inputs);
  return {BasicRgb<F>(material.base_color.rgb) * texel.rgb * inputs.color.rgb,
          F(material.base_color.a) * texel.a * inputs.color.a};
}

template <class F>
F coverage_of_alpha(const Material& material, const F& alpha) {
  switch (material.alpha_mode) {
    case AlphaMode::opaque:
      return F(1);
    case AlphaMode::mask:
      return select(alpha >= F(material.alpha_cutoff), F(1), F(0));
    case AlphaMode::blend:
      return unit_clamped(alpha);
  }
  return F(1);
}

bool may_transmit(const Material& material) {
  switch (material.model) {
    case ShadingModel::phong:
      return max_component(material.phong.transmission) > 0;
    case ShadingModel::metallic_roughness:
      return material.transmission > 0;
    case ShadingModel::unlit:
    case ShadingModel::measured:
      return false;
  }
  return false;
}

/// Whether the use leads to an image with texels. Opaque white, which stands in for others, is no direction.
bool has_texels(const TextureTable& table, const TextureUse& use) {
  if (!table.textures || !table.images || use.texture >= table.textures->size()) return false;
  const uint32_t image = (*table.textures)[use.texture].image;
  return image < table.images->size() && (*table.images)[image].width > 0;
}

Rgb half_thickness_transmittance(const Volume& volume, const TextureTable& table, const SurfaceInputs& inputs) {
  const float texel = sample(table, volume.thickness_texture, ColorSpace::linear, inputs).rgb.g;
  const Rgb sigma = attenuation_per_metre(volume);
  const float distance = volume.thickness * texel / 2;
  return {std::exp(-sigma.r * distance), std::exp(-sigma.g * distance), std::exp(-sigma.b * distance)};
}

}  // namespace

template <class F>
F coverage(const Material& material, const TextureTable& table, const BasicSurfaceInputs<F>& inputs) noexcept {
  if (material.alpha_mode == AlphaMode::opaque) return F(1);
  return coverage_of_alpha(material, base_color(material, table, inputs).a);
}
template float coverage(const Material&, const TextureTable&, const SurfaceInputs&) noexcept;
template ShadingLanes coverage(const Material&, const TextureTable&, const BasicSurfaceInputs<ShadingLanes>&) noexcept;

Rgb straight_transmittance(const Material& material, const TextureTable& table, const SurfaceInputs& inputs) noexcept {
  const bool transmits = may_transmit(material);
  if (!transmits && material.alpha_mode == AlphaMode::opaque) return {};
  const Rgba base = base_color(material, table, inputs);
  Rgb t;
  if (transmits && material.model == ShadingModel::phong) {
    t = material.phong.transmission;
  } else if (transmits) {
    const float texel = sample(table, material.transmission_texture, ColorSpace::linear, inputs).rgb.r;
    t = base.rgb * std::clamp(material.transmission * texel, 0.0f, 1.0f);
    if (material.volume.is_body()) t *= half_thickness_transmittance(material.volume, table, inputs);
  }
  return lerp(Rgb{1.0f}, t, coverage_of_alpha(material, base.a));
}

Opacity opacity(const Material& material) noexcept {
  if (material.alpha_mode == AlphaMode::mask) return Opacity::cutout;
  return material.alpha_mode == AlphaMode::blend || may_transmit(material) ? Opacity::transparent : Opacity::opaque;
}

template <class F>
BasicRgb<F> emission(const Material& material, const TextureTable& table,
                     const BasicSurfaceInputs<F>& inputs) noexcept {
  // KHR_materials_unlit: the base colour is all there is to see, whatever the lights and emissiveFactor.
  if (material.model == ShadingModel::unlit) return base_color(material, table, inputs).rgb;
  if (!(max_component(material.emissive) > 0)) return BasicRgb<F>(F(0));
  return BasicRgb<F>(material.emissive) * sample(table, material.emissive_texture, ColorSpace::srgb, inputs).rgb;
}
template Rgb emission(const Material&, const TextureTable&, const SurfaceInputs&) noexcept;
template BasicRgb<ShadingLanes> emission(const Material&, const TextureTable&,
                                         const BasicSurfaceInputs<ShadingLanes>&) noexcept;

template <class F>
Vec3<F> tangent_space_normal(const TextureUse& texture, float scale, const TextureTable& table,
                             const BasicSurfaceInputs<F>& inputs) noexcept {
  const Vec3<F> up{F(0), F(0), F(1)};
  if (!has_texels(table, texture)) return up;
  const BasicRgb<F> texel = sample(table, texture, ColorSpace::linear, inputs).rgb;
  const Vec3<F> n{(F(2) * texel.r - F(1)) * F(scale), (F(2) * texel.g - F(1)) * F(scale), F(2) * texel.b - F(1)};
  const F squared = dot(n, n);
  return select(MaskOf<F>(n.z > F(0) && squared - squared == F(0)), normalize(n), up);
}
template Vec3f tangent_space_normal(const TextureUse&, float, const TextureTable&, const SurfaceInputs&) noexcept;
template Vec3<ShadingLanes> tangent_space_normal(const TextureUse&, float, const TextureTable&,
                                                 const BasicSurfaceInputs<ShadingLanes>&) noexcept;

float anisotropy_angle(const Material& material, const TextureTable& table, const SurfaceInputs& inputs) noexcept {
  const Anisotropy& a = material.anisotropy;
  if (!has_texels(table, a.texture)) return a.rotation;
  const Rgb texel = sample(table, a.texture, ColorSpace::linear, inputs).rgb;
  return a.rotation + std::atan2(2 * texel.g - 1, 2 * texel.r - 1);
}

Rgb attenuation_per_metre(const Volume& volume) noexcept {
  if (!volume.is_body() || !(volume.attenuation_distance < std::numeric_limits<float>::infinity())) return {};
  const auto by_metre = [&](float c) {
    return -std::log(std::clamp(c, 1e-6f, 1.0f)) / std::max(volume.attenuation_distance, 1e-12f);
  };
  const Rgb& c = volume.attenuation_color;
  return {by_metre(c.r), by_metre(c.g), by_metre(c.b)};
}

}  // namespace alhazen
