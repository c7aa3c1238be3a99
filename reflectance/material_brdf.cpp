#include "reflectance/material_brdf.h"

#include <array>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "inspect/labels.h"
#include "inspect/tree_words.h"
#include "materials/fresnel.h"

namespace alhazen {
namespace {

constexpr float kInvPi = std::numbers::inv_pi_v<float>;
constexpr Vec3f kNormal{0, 0, 1};
const Rgb kBlack{0.0f};

bool above(const Vec3f& s, const Vec3f& b) { return s.z > 0 && b.z > 0; }

std::string text(double v) { return short_number(v); }
std::string text(const Rgb& c) { return short_color(c); }

using Settings = std::vector<std::pair<std::string, std::string>>;

Settings phong_settings(const PhongBsdf& bsdf) {
  Settings settings{{"diffuse", text(bsdf.diffuse)}};
  if (bsdf.specular != kBlack)
    settings.insert(settings.end(), {{"specular", text(bsdf.specular)}, {"shininess", text(double(bsdf.shininess))}});
  if (bsdf.reflection != kBlack) settings.emplace_back("reflection", text(bsdf.reflection));
  if (bsdf.transmission != kBlack) settings.emplace_back("transmission", text(bsdf.transmission));
  if (bsdf.fresnel || bsdf.transmission != kBlack) settings.emplace_back("ior", text(double(bsdf.ior)));
  if (bsdf.fresnel) settings.emplace_back("fresnel", "true");
  return settings;
}

Settings layer_settings(const MetallicRoughnessBsdf& bsdf) {
  Settings settings{{"base color", text(bsdf.base_color)},
                    {"metallic", text(double(bsdf.metallic))},
                    {"roughness", text(double(bsdf.roughness))}};
  const auto add = [&](bool used, const char* name, const auto& value) {
    if (used) settings.emplace_back(name, text(value));
  };
  add(bsdf.metallic < 1 && std::abs(max_component(bsdf.dielectric_f0) - 0.04f) > 1e-4f, "F0", bsdf.dielectric_f0);
  add(bsdf.transmission > 0, "transmission", double(bsdf.transmission));
  add(bsdf.diffuse_transmission > 0, "diffuse transmission", double(bsdf.diffuse_transmission));
  add(bsdf.anisotropy > 0, "anisotropy", double(bsdf.anisotropy));
  add(bsdf.iridescence > 0, "iridescence", double(bsdf.iridescence));
  add(bsdf.iridescence > 0, "film, nm", double(bsdf.film_thickness_nm));
  add(bsdf.sheen_color != kBlack, "sheen", bsdf.sheen_color);
  add(bsdf.sheen_color != kBlack, "sheen roughness", double(bsdf.sheen_roughness));
  add(bsdf.clearcoat > 0, "clearcoat", double(bsdf.clearcoat));
  add(bsdf.clearcoat > 0, "clearcoat roughness", double(bsdf.clearcoat_roughness));
  return settings;
}

Brdf layered_brdf(const MetallicRoughnessBsdf& bsdf, float angle) {
  LayerFrames frames(kNormal);
  frames.base = {{std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}, kNormal};
  return [=](const Vec3f& s, const Vec3f& b) {
    return above(s, b) ? reflected_light(bsdf, frames, s, b) * (1 / s.z) : Rgb{};
  };
}

/// Glass lets the rest of a ray through, past what its base and the layers above it keep.
SmoothPart transmitted_part(const MetallicRoughnessBsdf& bsdf) {
  const float share = bsdf.transmission * (1 - bsdf.metallic);
  if (!(share > 0)) return {};
  return [=](float cos_theta) {
    const Vec3f b{std::sqrt(std::max(0.0f, 1 - cos_theta * cos_theta)), 0, cos_theta};
    const float left = layers_transmittance(bsdf, LayerFrames(kNormal), b);
    return RayShares{{}, (Rgb(1.0f) - specular_reflectance(bsdf, cos_theta)) * bsdf.base_color * (left * share)};
  };
}

void note_surroundings(const Material& material, Subject& subject) {
  if (material.normal_texture) subject.notes.push_back("Its normal texture is left out.");
  if (material.alpha_mode != AlphaMode::opaque)
    subject.notes.push_back("Where its alpha leaves holes, nothing is reflected; that is left out.");
}

}  // namespace

Subject phong_subject(const PhongBsdf& bsdf) {
  Subject subject{.name = {},
                  .model = "Phong (ALHAZEN_materials_phong)",
                  .settings = phong_settings(bsdf),
                  .brdf = {},
                  .smooth = {},
                  .notes = {"A light of 1 is read as pi of irradiance, so that the diffuse factor is an albedo; read "
                            "as glTF's lux, pi times as "
                            "much is reflected."}};
  subject.brdf = [=](const Vec3f& s, const Vec3f& b) {
    return above(s, b) ? reflected_light(bsdf, kNormal, s, b) * (kInvPi / s.z) : Rgb{};
  };
  if (bsdf.reflection == kBlack && bsdf.transmission == kBlack) return subject;
  subject.smooth = [=](float cos_theta) {
    const float eta = 1 / bsdf.ior;  // from outside: nothing is reflected totally
    const PhongRays rays = ray_weights(bsdf, bsdf.fresnel ? fresnel_dielectric(cos_theta, eta) : 0, true);
    return RayShares{rays.mirrored, rays.refracted};
  };
  subject.notes.push_back(
      "Mirror and refracted rays have no lobe: their shares, from outside, are the curves R and T. What lamps light "
      "goes by the lobe, all else by these rays.");
  return subject;
}

Subject layered_subject(const MetallicRoughnessBsdf& bsdf, float angle) {
  Subject subject{.name = {},
                  .model = "glTF metallic-roughness",
                  .settings = layer_settings(bsdf),
                  .brdf = layered_brdf(bsdf, angle),
                  .smooth = transmitted_part(bsdf),
                  .notes = {}};
  if (subject.smooth)
    subject.notes.push_back("What passes goes on as a ray and has no lobe: its share is the curve T.");
  if (bsdf.diffuse_transmission > 0)
    subject.notes.push_back("What shines through to the other side is not shown and not counted.");
  return subject;
}

Subject measured_subject(std::shared_ptr<const MeasuredBrdf> brdf, float scale) {
  const MeasuredGrid& grid = brdf->table.grid;
  Subject subject{.name = brdf->name,
                  .model = "measured",
                  .settings = {{"entries", std::to_string(grid.theta_h) + " x " + std::to_string(grid.theta_d) + " x " +
                                               std::to_string(grid.phi_d)},
                               {"known", text(double(std::round(100 * brdf->known))) + " %"}},
                  .brdf = {},
                  .smooth = {},
                  .notes = {"Entries that are not known, those below the horizon too, have taken their nearest "
                            "neighbours' values."}};
  if (scale != 1) subject.settings.emplace_back("scale", text(double(scale)));
  subject.brdf = [brdf = std::move(brdf), scale](const Vec3f& s, const Vec3f& b) {
    return evaluate(brdf->table, kNormal, s, b) * scale;
  };
  return subject;
}

Subject material_subject(const Scene& scene, uint32_t index, Vec2f uv) {
  const Material& material = scene.materials[index];
  const TextureTable table = texture_table(scene);
  std::array<Vec2f, kMaxUvSets> uvs;
  uvs.fill(uv);
  const SurfaceInputs inputs{.uvs = uvs.data(), .uv_count = int(uvs.size()), .color = {}};
  const std::string name = material_label(scene, index);
  if (material.model == ShadingModel::unlit)
    throw UsageError("--material: '" + name + "' is unlit: it reflects nothing, whatever the light");
  const auto subject_of_model = [&] {
    switch (material.model) {
      case ShadingModel::phong:
        return phong_subject(phong_bsdf(material, table, inputs));
      case ShadingModel::measured:
        return measured_subject(std::make_shared<MeasuredBrdf>(scene.measured[material.measured.brdf]),
                                material.measured.scale);
      default:
        return layered_subject(metallic_roughness_bsdf(material, table, inputs),
                               anisotropy_angle(material, table, inputs));
    }
  };
  Subject subject = subject_of_model();
  subject.name = name;
  note_surroundings(material, subject);
  return subject;
}

}  // namespace alhazen
