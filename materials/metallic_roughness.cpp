#include "materials/metallic_roughness.h"

#include <numbers>

#include "materials/thin_film.h"

namespace alhazen {
namespace {

constexpr float kInvPi = std::numbers::inv_pi_v<float>;
constexpr float kCoatF0 = 0.04f;  // index of refraction 1.5

float unit(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }  // NaN becomes 0

Rgb with_film(const MetallicRoughnessBsdf& bsdf, const Rgb& bare, const Rgb& f0, float cos_theta) {
  if (!(bsdf.iridescence > 0)) return bare;
  const Rgb film = thin_film_fresnel(unit(cos_theta), bsdf.film_ior, bsdf.film_thickness_nm, f0);
  return lerp(bare, film, bsdf.iridescence);
}

Rgb dielectric_fresnel(const MetallicRoughnessBsdf& bsdf, float cos_theta) {
  const Rgb bare = fresnel_schlick(bsdf.dielectric_f0, bsdf.dielectric_f90, cos_theta);
  return with_film(bsdf, bare, bsdf.dielectric_f0, cos_theta);
}

Rgb metal_fresnel(const MetallicRoughnessBsdf& bsdf, float cos_theta) {
  return with_film(bsdf, fresnel_schlick(bsdf.base_color, 1, cos_theta), bsdf.base_color, cos_theta);
}

Rgb base_light(const MetallicRoughnessBsdf& bsdf, const LayerFrames& frames, const Vec3f& s, const Vec3f& b,
               const Vec3f& h) {
  const float ns = dot(frames.base.n, s), bh = dot(b, h);
  const float specular = ggx(alpha_of(bsdf.roughness, bsdf.anisotropy), frames.base, s, b, h);
  const Rgb diffuse = bsdf.base_color * (kInvPi * (1 - bsdf.transmission) * (1 - bsdf.diffuse_transmission));
  return base_light(bsdf, BaseFresnel<float>{dielectric_fresnel(bsdf, bh), metal_fresnel(bsdf, bh)}, diffuse, specular,
                    ns);
}

/// Of light from behind: there is no half vector to reflect about, so the view's angle says what the surface keeps.
Rgb light_from_behind(const MetallicRoughnessBsdf& bsdf, const LayerFrames& frames, const Vec3f& s, const Vec3f& b) {
  const float share = bsdf.diffuse_transmission * (1 - bsdf.transmission) * (1 - bsdf.metallic);
  if (!(share > 0)) return {};
  const float kept = max_component(dielectric_fresnel(bsdf, std::max(0.0f, dot(frames.base.n, b))));
  return bsdf.diffuse_transmission_color *
         (share * (1 - kept) * kInvPi * -dot(frames.base.n, s) * layers_transmittance(bsdf, frames, b));
}

/// What sheen leaves of the layers below it, for light to or from a direction.
float sheen_transmittance(const MetallicRoughnessBsdf& bsdf, float cos_theta) {
  const float color = max_component(bsdf.sheen_color);
  return color > 0 ? 1 - color * charlie_albedo(bsdf.sheen_roughness, cos_theta) : 1;
}

}  // namespace

MetallicRoughnessBsdf metallic_roughness_bsdf(const Material& material, const TextureTable& table,
                                              const SurfaceInputs& inputs, float relative_ior) noexcept {
  const auto linear = [&](const TextureUse& use) { return sample(table, use, ColorSpace::linear, inputs); };
  const auto srgb = [&](const TextureUse& use) { return sample(table, use, ColorSpace::srgb, inputs).rgb; };
  MetallicRoughnessBsdf bsdf{base_layer(material, table, inputs, relative_ior)};
  if (const DiffuseTransmission& d = material.diffuse_transmission; d.factor > 0) {
    bsdf.diffuse_transmission = unit(d.factor * linear(d.texture).a);
    bsdf.diffuse_transmission_color = d.color * srgb(d.color_texture);
  }
  if (const Anisotropy& a = material.anisotropy; a.strength > 0)
    bsdf.anisotropy = unit(a.strength * linear(a.texture).rgb.b);
  if (const Iridescence& i = material.iridescence; i.factor > 0) {
    bsdf.iridescence = unit(i.factor * linear(i.texture).rgb.r);
    bsdf.film_ior = i.ior;
    const float t = linear(i.thickness_texture).rgb.g;
    bsdf.film_thickness_nm = i.thickness_min_nm + (i.thickness_max_nm - i.thickness_min_nm) * t;
  }
  if (const Sheen& sheen = material.sheen; max_component(sheen.color) > 0) {
    bsdf.sheen_color = sheen.color * srgb(sheen.color_texture);
    bsdf.sheen_roughness = unit(sheen.roughness * linear(sheen.roughness_texture).a);
  }
  if (const Clearcoat& coat = material.clearcoat; coat.factor > 0) {
    bsdf.clearcoat = unit(coat.factor * linear(coat.texture).rgb.r);
    bsdf.clearcoat_roughness = unit(coat.roughness * linear(coat.roughness_texture).rgb.g);
  }
  return bsdf;
}

Rgb reflected_light(const MetallicRoughnessBsdf& bsdf, const LayerFrames& frames, const Vec3f& s,
                    const Vec3f& b) noexcept {
  const float ns = dot(frames.base.n, s);
  if (!(ns > 0)) return light_from_behind(bsdf, frames, s, b);
  const Vec3f h = unit_vector(s + b);
  Rgb light = base_light(bsdf, frames, s, b, h);
  if (max_component(bsdf.sheen_color) > 0) {
    const float nb = std::max(0.0f, dot(frames.base.n, b));
    const float sheen = charlie(bsdf.sheen_roughness, ns, nb, dot(frames.base.n, h));
    light = light * std::min(sheen_transmittance(bsdf, nb), sheen_transmittance(bsdf, ns)) +
            bsdf.sheen_color * (sheen * ns);
  }
  if (bsdf.clearcoat > 0) {
    const float kept = coat_reflectance(bsdf, frames.coat_n, b), coat_ns = dot(frames.coat_n, s);
    const ShadingFrame coat{{}, {}, frames.coat_n};  // isotropic: the axes across do not matter
    const float lobe = coat_ns > 0 ? ggx(alpha_of(bsdf.clearcoat_roughness), coat, s, b, h) * coat_ns : 0;
    light = light * (1 - kept) + Rgb{kept * lobe};
  }
  return light;
}

DiffuseAlbedo diffuse_albedo(const MetallicRoughnessBsdf& bsdf, const LayerFrames& frames, const Vec3f& b) noexcept {
  const float share = (1 - bsdf.metallic) * (1 - bsdf.transmission), left = layers_transmittance(bsdf, frames, b);
  const float nb = std::max(0.0f, dot(frames.base.n, b));
  Rgb front = bsdf.base_color * (share * (1 - bsdf.diffuse_transmission) * left);
  if (max_component(bsdf.sheen_color) > 0)
    front +=
        bsdf.sheen_color * (charlie_albedo(bsdf.sheen_roughness, nb) * (1 - coat_reflectance(bsdf, frames.coat_n, b)));
  return {front, bsdf.diffuse_transmission_color * (share * bsdf.diffuse_transmission * left)};
}

Rgb specular_reflectance(const MetallicRoughnessBsdf& bsdf, float cos_theta) noexcept {
  return lerp(dielectric_fresnel(bsdf, cos_theta), metal_fresnel(bsdf, cos_theta), bsdf.metallic);
}

Rgb specular_albedo(const MetallicRoughnessBsdf& bsdf, float cos_theta) noexcept {
  const SplitSum split = ggx_albedo(bsdf.roughness, cos_theta);
  const Rgb dielectric = with_film(bsdf, bsdf.dielectric_f0, bsdf.dielectric_f0, cos_theta) * split.scale +
                         Rgb{bsdf.dielectric_f90 * split.bias};
  const Rgb metal = with_film(bsdf, bsdf.base_color, bsdf.base_color, cos_theta) * split.scale + Rgb{split.bias};
  return lerp(dielectric, metal, bsdf.metallic);
}

float layers_transmittance(const MetallicRoughnessBsdf& bsdf, const LayerFrames& frames, const Vec3f& b) noexcept {
  const float nb = std::max(0.0f, dot(frames.base.n, b));
  return sheen_transmittance(bsdf, nb) * (1 - coat_reflectance(bsdf, frames.coat_n, b));
}

float coat_reflectance(const MetallicRoughnessBsdf& bsdf, const Vec3f& coat_n, const Vec3f& b) noexcept {
  if (!(bsdf.clearcoat > 0)) return 0;
  return bsdf.clearcoat * fresnel_schlick(Rgb{kCoatF0}, 1, std::abs(dot(coat_n, b))).r;
}

}  // namespace alhazen
