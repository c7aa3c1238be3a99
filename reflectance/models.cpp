#include "reflectance/models.h"

#include <cmath>
#include <numbers>

#include "inspect/tree_words.h"
#include "materials/fresnel.h"
#include "reflectance/material_brdf.h"

namespace alhazen {
namespace {

constexpr float kPi = std::numbers::pi_v<float>, kInvPi = std::numbers::inv_pi_v<float>;
constexpr Vec3f kNormal{0, 0, 1};

PhongBsdf phong_without_rays(const Rgb& diffuse, const Rgb& specular, float shininess) {
  return {.ambient = diffuse,
          .diffuse = diffuse,
          .specular = specular,
          .shininess = shininess,
          .reflection = {},
          .transmission = {},
          .ior = 1,
          .fresnel = false};
}

Subject lambert(const ModelSettings& settings) {
  Subject subject = phong_subject(phong_without_rays(settings.diffuse, {}, 1));
  subject.model = "Lambert", subject.notes.clear();
  return subject;
}

Subject phong(const ModelSettings& settings) {
  return phong_subject(phong_without_rays(settings.diffuse, settings.specular, settings.shininess));
}

/// E. Lafortune and Y. Willems, Using the Modified Phong Reflectance Model for Physically Based Rendering, 1994:
/// without the division by n·s it is reciprocal, and (alpha + 2) / 2 pi makes the whole lobe, as seen at the normal, 1.
Subject normalised_phong(const ModelSettings& settings) {
  Subject subject = phong(settings);
  subject.model = "normalised Phong (Lafortune and Willems 1994)", subject.notes.clear();
  const Rgb diffuse = settings.diffuse * kInvPi;
  const Rgb specular = settings.specular * ((settings.shininess + 2) / (2 * kPi));
  subject.brdf = [=, shininess = settings.shininess](const Vec3f& s, const Vec3f& b) {
    if (!(s.z > 0 && b.z > 0)) return Rgb{};
    const float rb = s.z * b.z - s.x * b.x - s.y * b.y;
    return diffuse + (rb > 0 ? specular * std::pow(std::min(rb, 1.0f), shininess) : Rgb{});
  };
  return subject;
}

/// A microfacet lobe alone, with Schlick's Fresnel from `specular` at the normal.
Subject ggx_lobe(const ModelSettings& settings) {
  const Alpha alpha = alpha_of(settings.roughness, settings.anisotropy);
  Subject subject{
      .name = {},
      .model = "GGX with Schlick's Fresnel",
      .settings = {{"F0", short_color(settings.specular)}, {"roughness", short_number(double(settings.roughness))}},
      .brdf = {},
      .smooth = {},
      .notes = {}};
  if (settings.anisotropy > 0) subject.settings.emplace_back("anisotropy", short_number(double(settings.anisotropy)));
  subject.brdf = [=, f0 = settings.specular, frame = ShadingFrame{{1, 0, 0}, {0, 1, 0}, kNormal}](const Vec3f& s,
                                                                                                  const Vec3f& b) {
    if (!(s.z > 0 && b.z > 0)) return Rgb{};
    const Vec3f h = normalize(s + b);
    return fresnel_schlick(f0, 1, dot(b, h)) * ggx(alpha, frame, s, b, h);
  };
  return subject;
}

Subject gltf(const ModelSettings& settings) {
  Material material;
  material.base_color.rgb = settings.diffuse;
  material.metallic = settings.metallic, material.roughness = settings.roughness, material.ior = settings.ior;
  return layered_subject(metallic_roughness_bsdf(material, {}, {}), 0);
}

/// A smooth boundary: rays alone.
Subject dielectric(const ModelSettings& settings) {
  PhongBsdf bsdf = phong_without_rays({}, {}, 1);
  bsdf.reflection = bsdf.transmission = Rgb(1.0f), bsdf.ior = settings.ior, bsdf.fresnel = true;
  Subject subject = phong_subject(bsdf);
  subject.model = "smooth dielectric (Fresnel)";
  subject.settings = {{"ior", short_number(double(settings.ior))}};
  subject.notes = {"Rays have no lobe: R and T are the shares that are mirrored and refracted, from outside."};
  return subject;
}

}  // namespace

const std::vector<ReflectanceModel>& reflectance_models() {
  static const std::vector<ReflectanceModel> models{
      {"lambert", "equally bright from everywhere", {"diffuse"}, lambert},
      {"phong", "the course's two components", {"diffuse", "specular", "shininess"}, phong},
      {"normalised-phong", "Lafortune and Willems's", {"diffuse", "specular", "shininess"}, normalised_phong},
      {"ggx", "microfacets", {"specular", "roughness", "anisotropy"}, ggx_lobe},
      {"gltf", "metallic-roughness", {"diffuse", "metallic", "roughness", "ior"}, gltf},
      {"dielectric", "smooth glass", {"ior"}, dielectric}};
  return models;
}

}  // namespace alhazen
