#include "materials/metallic_roughness.h"

#include <numbers>

#include "materials/fresnel.h"

namespace alhazen {
namespace {

constexpr float kInvPi = std::numbers::inv_pi_v<float>;

float unit(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }  // NaN becomes 0

Rgb dielectric_fresnel(const MetallicRoughnessBsdf& bsdf, float cos_theta) {
  return fresnel_schlick(bsdf.dielectric_f0, bsdf.dielectric_f90, cos_theta);
}

Rgb metal_fresnel(const MetallicRoughnessBsdf& bsdf, float cos_theta) {
  return fresnel_schlick(bsdf.base_color, 1, cos_theta);
}

}  // namespace

MetallicRoughnessBsdf metallic_roughness_bsdf(const Material& material, const TextureTable& table,
                                              const SurfaceInputs& inputs) noexcept {
  const auto look_up = [&](const TextureUse& use, ColorSpace space) {
    return sample(table, use, space, inputs.uvs, inputs.uv_count);
  };
  const Rgb metal_rough = look_up(material.metallic_roughness_texture, ColorSpace::linear).rgb;
  const float specular = unit(material.specular * look_up(material.specular_texture, ColorSpace::linear).a);
  const Rgb tint = material.specular_color * look_up(material.specular_color_texture, ColorSpace::srgb).rgb;
  const float occlusion = look_up(material.occlusion_texture, ColorSpace::linear).rgb.r;
  const float root = material.ior == 0 ? 1 : (material.ior - 1) / (material.ior + 1);
  const Rgb f0 = root * root * tint;

  MetallicRoughnessBsdf bsdf;
  bsdf.base_color =
      material.base_color.rgb * inputs.color.rgb * look_up(material.base_color_texture, ColorSpace::srgb).rgb;
  bsdf.metallic = unit(material.metallic * metal_rough.b);
  bsdf.roughness = unit(material.roughness * metal_rough.g);
  bsdf.dielectric_f0 = Rgb{unit(f0.r), unit(f0.g), unit(f0.b)} * specular;
  bsdf.dielectric_f90 = specular;
  bsdf.transmission = unit(material.transmission * look_up(material.transmission_texture, ColorSpace::linear).rgb.r);
  bsdf.occlusion = unit(1 + material.occlusion_strength * (occlusion - 1));
  bsdf.ior = material.ior;
  return bsdf;
}

Rgb reflected_light(const MetallicRoughnessBsdf& bsdf, const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept {
  const float ns = dot(n, s);
  if (!(ns > 0)) return {};
  const float nb = std::max(0.0f, dot(n, b));
  const Vec3f h = normalize(s + b);
  const float nh = dot(n, h), bh = dot(b, h);

  const float alpha = std::max(1e-3f, bsdf.roughness * bsdf.roughness), a2 = alpha * alpha;
  float specular = 0;
  if (nh > 0) {
    // 1 - (n·h)² as |n x h|²: no cancellation where a sharp highlight needs the digits.
    const Vec3f nxh = cross(n, h);
    const float q = dot(nxh, nxh) + a2 * nh * nh;
    const float distribution = a2 * kInvPi / (q * q);
    const float visibility = 0.5f / (ns * std::sqrt(nb * nb * (1 - a2) + a2) + nb * std::sqrt(ns * ns * (1 - a2) + a2));
    specular = distribution * visibility;
  }

  const Rgb fresnel = dielectric_fresnel(bsdf, bh);
  const Rgb diffuse = bsdf.base_color * (kInvPi * (1 - bsdf.transmission));
  const Rgb dielectric = diffuse * (1 - max_component(fresnel)) + fresnel * specular;
  const Rgb metal = metal_fresnel(bsdf, bh) * specular;
  return lerp(dielectric, metal, bsdf.metallic) * ns;
}

Rgb diffuse_albedo(const MetallicRoughnessBsdf& bsdf) noexcept {
  return bsdf.base_color * ((1 - bsdf.metallic) * (1 - bsdf.transmission));
}

Rgb specular_reflectance(const MetallicRoughnessBsdf& bsdf, float cos_theta) noexcept {
  return lerp(dielectric_fresnel(bsdf, cos_theta), metal_fresnel(bsdf, cos_theta), bsdf.metallic);
}

float mirror_share(float roughness) noexcept {
  const float t = unit(2 * roughness);
  return 1 - t * t * (3 - 2 * t);
}

}  // namespace alhazen
