#include "loaders/gltf_layers.h"

#include <array>
#include <cmath>

namespace alhazen {
namespace {

/// KHR_texture_transform: translation * rotation * scale; angles turn from v to u, for v points down.
void set_transform(const JsonRef& r, TextureUse& use) {
  const auto offset = r.get("offset", std::array{0.0, 0.0}), scale = r.get("scale", std::array{1.0, 1.0});
  const double angle = r.get("rotation", 0.0), c = std::cos(angle), s = std::sin(angle);
  use.uv_set = r.get("texCoord", use.uv_set);
  use.xx = float(c * scale[0]), use.xy = float(s * scale[1]), use.x0 = float(offset[0]);
  use.yx = float(-s * scale[0]), use.yy = float(c * scale[1]), use.y0 = float(offset[1]);
}

void read_clearcoat(const JsonRef& e, const TextureReader& texture_use, Clearcoat& c) {
  c.factor = e.get("clearcoatFactor", c.factor);
  c.texture = texture_use(e, "clearcoatTexture");
  c.roughness = e.get("clearcoatRoughnessFactor", c.roughness);
  c.roughness_texture = texture_use(e, "clearcoatRoughnessTexture");
  c.normal_texture = texture_use(e, "clearcoatNormalTexture");
  if (const auto normal = e.find("clearcoatNormalTexture")) c.normal_scale = normal->get("scale", c.normal_scale);
}

void read_sheen(const JsonRef& e, const TextureReader& texture_use, Sheen& s) {
  s.color = e.get("sheenColorFactor", s.color);
  s.color_texture = texture_use(e, "sheenColorTexture");
  s.roughness = e.get("sheenRoughnessFactor", s.roughness);
  s.roughness_texture = texture_use(e, "sheenRoughnessTexture");
}

void read_anisotropy(const JsonRef& e, const TextureReader& texture_use, Anisotropy& a) {
  a.strength = e.get("anisotropyStrength", a.strength);
  a.rotation = e.get("anisotropyRotation", a.rotation);
  a.texture = texture_use(e, "anisotropyTexture");
}

void read_iridescence(const JsonRef& e, const TextureReader& texture_use, Iridescence& i) {
  i.factor = e.get("iridescenceFactor", i.factor);
  i.texture = texture_use(e, "iridescenceTexture");
  i.ior = e.get("iridescenceIor", i.ior);
  i.thickness_min_nm = e.get("iridescenceThicknessMinimum", i.thickness_min_nm);
  i.thickness_max_nm = e.get("iridescenceThicknessMaximum", i.thickness_max_nm);
  i.thickness_texture = texture_use(e, "iridescenceThicknessTexture");
}

void read_diffuse_transmission(const JsonRef& e, const TextureReader& texture_use, DiffuseTransmission& d) {
  d.factor = e.get("diffuseTransmissionFactor", d.factor);
  d.texture = texture_use(e, "diffuseTransmissionTexture");
  d.color = e.get("diffuseTransmissionColorFactor", d.color);
  d.color_texture = texture_use(e, "diffuseTransmissionColorTexture");
}

void read_volume(const JsonRef& e, const TextureReader& texture_use, Volume& v) {
  v.thickness = e.get("thicknessFactor", v.thickness);
  v.thickness_texture = texture_use(e, "thicknessTexture");
  v.attenuation_distance = e.get("attenuationDistance", v.attenuation_distance);
  v.attenuation_color = e.get("attenuationColor", v.attenuation_color);
}

}  // namespace

TextureUse texture_use(const JsonRef& owner, const char* key) {
  TextureUse use;
  if (const auto info = owner.find(key)) {
    use.texture = (*info)["index"].as<uint32_t>();
    use.uv_set = info->get("texCoord", 0u);
    if (const auto transform = info->extension("KHR_texture_transform")) set_transform(*transform, use);
  }
  return use;
}

void read_layers(const JsonRef& material, const TextureReader& texture_use, Material& m) {
  const auto with = [&](const char* name, const auto& read, auto& part) {
    if (const auto e = material.extension(name)) read(*e, texture_use, part);
  };
  with("KHR_materials_clearcoat", read_clearcoat, m.clearcoat);
  with("KHR_materials_sheen", read_sheen, m.sheen);
  with("KHR_materials_anisotropy", read_anisotropy, m.anisotropy);
  with("KHR_materials_iridescence", read_iridescence, m.iridescence);
  with("KHR_materials_diffuse_transmission", read_diffuse_transmission, m.diffuse_transmission);
  with("KHR_materials_volume", read_volume, m.volume);
  if (const auto e = material.extension("KHR_materials_dispersion"))
    m.volume.dispersion = e->get("dispersion", m.volume.dispersion);
}

std::optional<uint32_t> tangent_uv_set(const Material& material) {
  if (material.normal_texture) return material.normal_texture.uv_set;
  if (material.clearcoat.normal_texture) return material.clearcoat.normal_texture.uv_set;
  if (material.anisotropy.strength > 0) return material.anisotropy.texture.uv_set;
  return {};
}

std::vector<Property> layer_properties(const std::function<Check(std::vector<Property>)>& texture_info) {
  const Check texture = texture_info({}), share = number(0, 1), positive = number_above(0);
  return {{"KHR_materials_clearcoat", object({{"clearcoatFactor", share},
                                              {"clearcoatTexture", texture},
                                              {"clearcoatRoughnessFactor", share},
                                              {"clearcoatRoughnessTexture", texture},
                                              {"clearcoatNormalTexture", texture_info({{"scale", number()}})}})},
          {"KHR_materials_sheen", object({{"sheenColorFactor", numbers(3, 0, 1)},
                                          {"sheenColorTexture", texture},
                                          {"sheenRoughnessFactor", share},
                                          {"sheenRoughnessTexture", texture}})},
          {"KHR_materials_anisotropy",
           object({{"anisotropyStrength", share}, {"anisotropyRotation", number()}, {"anisotropyTexture", texture}})},
          {"KHR_materials_iridescence", object({{"iridescenceFactor", share},
                                                {"iridescenceTexture", texture},
                                                {"iridescenceIor", number(1)},
                                                {"iridescenceThicknessMinimum", number(0)},
                                                {"iridescenceThicknessMaximum", number(0)},
                                                {"iridescenceThicknessTexture", texture}})},
          {"KHR_materials_diffuse_transmission", object({{"diffuseTransmissionFactor", share},
                                                         {"diffuseTransmissionTexture", texture},
                                                         {"diffuseTransmissionColorFactor", color()},
                                                         {"diffuseTransmissionColorTexture", texture}})},
          {"KHR_materials_volume", object({{"thicknessFactor", number(0)},
                                           {"thicknessTexture", texture},
                                           {"attenuationDistance", positive},
                                           {"attenuationColor", numbers(3, 0, 1)}})},
          {"KHR_materials_dispersion", object({{"dispersion", number(0)}})}};
}

}  // namespace alhazen
