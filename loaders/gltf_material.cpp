#include "loaders/gltf_material.h"

#include <array>
#include <map>

#include "loaders/gltf_layers.h"

namespace alhazen {
namespace {

// ---- Textures ----

class MaterialReader {
 public:
  MaterialReader(const GltfSource& source, GltfMaterials& all) : source_(source), all_(all) {
    all_.uses_texture.resize(source.model.textures.size());
  }

  Material read(size_t i) {
    const JsonRef r = source_.at("materials", i);
    Material m;
    read_core(r, m);
    if (const auto e = r.extension("KHR_materials_pbrSpecularGlossiness")) read_specular_glossiness(*e, m);
    read_khronos(r, m);
    if (const auto phong = r.extension("ALHAZEN_materials_phong")) {
      m.model = ShadingModel::phong;
      read_phong(*phong, m.phong);
    }
    if (const auto measured = r.extension("ALHAZEN_materials_measured")) {
      m.model = ShadingModel::measured;
      m.measured = {measured_file((*measured)["uri"]), measured->get("scale", 1.0f)};
    }
    return m;
  }

 private:
  /// The textureInfo `key` of `owner`; unused where there is none.
  TextureUse texture_use(const JsonRef& owner, const char* key) {
    const TextureUse use = alhazen::texture_use(owner, key);
    if (use) all_.uses_texture[use.texture] = 1;
    return use;
  }

  void read_core(const JsonRef& r, Material& m) {
    const auto alpha_mode = r.get("alphaMode", std::string("OPAQUE"));
    m.name = r.get("name", std::string{});
    m.alpha_mode = alpha_mode == "MASK"    ? AlphaMode::mask
                   : alpha_mode == "BLEND" ? AlphaMode::blend
                                           : AlphaMode::opaque;
    m.alpha_cutoff = r.get("alphaCutoff", 0.5f);
    m.double_sided = r.get("doubleSided", false);
    if (const auto p = r.find("pbrMetallicRoughness")) read_metallic_roughness(*p, m);
    m.normal_texture = texture_use(r, "normalTexture");
    if (const auto t = r.find("normalTexture")) m.normal_scale = t->get("scale", 1.0f);
    m.occlusion_texture = texture_use(r, "occlusionTexture");
    if (const auto t = r.find("occlusionTexture")) m.occlusion_strength = t->get("strength", 1.0f);
    m.emissive = r.get("emissiveFactor", Rgb{0.0f});
    m.emissive_texture = texture_use(r, "emissiveTexture");
  }

  void read_metallic_roughness(const JsonRef& r, Material& m) {
    const auto color = r.get("baseColorFactor", std::array{1.0f, 1.0f, 1.0f, 1.0f});
    m.base_color = {{color[0], color[1], color[2]}, color[3]};
    m.metallic = r.get("metallicFactor", 1.0f);
    m.roughness = r.get("roughnessFactor", 1.0f);
    m.base_color_texture = texture_use(r, "baseColorTexture");
    m.metallic_roughness_texture = texture_use(r, "metallicRoughnessTexture");
  }

  void read_khronos(const JsonRef& r, Material& m) {
    if (r.extension("KHR_materials_unlit")) m.model = ShadingModel::unlit;
    if (const auto e = r.extension("KHR_materials_emissive_strength"))
      m.emissive = m.emissive * e->get("emissiveStrength", 1.0f);
    if (const auto e = r.extension("KHR_materials_ior")) m.ior = e->get("ior", m.ior);
    if (const auto e = r.extension("KHR_materials_transmission")) {
      m.transmission = e->get("transmissionFactor", m.transmission);
      m.transmission_texture = texture_use(*e, "transmissionTexture");
    }
    read_layers(
        r, [this](const JsonRef& owner, const char* key) { return texture_use(owner, key); }, m);
    if (const auto e = r.extension("KHR_materials_specular")) {
      m.specular = e->get("specularFactor", m.specular);
      m.specular_texture = texture_use(*e, "specularTexture");
      m.specular_color = e->get("specularColorFactor", m.specular_color);
      m.specular_color_texture = texture_use(*e, "specularColorTexture");
    }
  }

  /// A dielectric whose F0 is the specular colour: infinite ior (written 0) makes F0 1, which specular_color scales.
  /// Exact but for light between the two lobes: glTF dims the diffuse one by the largest channel of Fresnel's term.
  void read_specular_glossiness(const JsonRef& r, Material& m) {
    const auto diffuse = r.get("diffuseFactor", std::array{1.0f, 1.0f, 1.0f, 1.0f});
    m.base_color = {{diffuse[0], diffuse[1], diffuse[2]}, diffuse[3]};
    m.base_color_texture = texture_use(r, "diffuseTexture");
    m.metallic = 0, m.metallic_roughness_texture = {};
    m.ior = 0;
    m.specular_color = r.get("specularFactor", Rgb{1.0f});
    m.specular_color_texture = texture_use(r, "specularGlossinessTexture");
    const float glossiness = r.get("glossinessFactor", 1.0f);
    m.roughness = m.specular_color_texture ? 1 : 1 - glossiness;
    if (!m.specular_color_texture) return;
    m.metallic_roughness_texture = m.specular_color_texture;
    m.metallic_roughness_texture.texture = uint32_t(all_.uses_texture.size() + all_.roughness.size());
    all_.roughness.push_back({m.specular_color_texture.texture, glossiness});
  }

  void read_phong(const JsonRef& r, PhongParameters& p) {
    p.diffuse = r.get("diffuseFactor", p.diffuse);
    p.diffuse_texture = texture_use(r, "diffuseTexture");
    p.ambient = r.get("ambientFactor", p.diffuse);
    const bool follows_diffuse = !r.has("ambientFactor") && !r.has("ambientTexture");
    p.ambient_texture = follows_diffuse ? p.diffuse_texture : texture_use(r, "ambientTexture");
    p.specular = r.get("specularFactor", p.specular);
    p.shininess = r.get("shininess", p.shininess);
    p.reflection = r.get("reflectionFactor", p.specular);
    p.transmission = r.get("transmissionFactor", p.transmission);
    p.ior = r.get("ior", p.ior);
    p.fresnel = r.get("fresnel", p.fresnel);
    p.takes_part = r.has("priority");
    p.priority = r.get("priority", p.priority);
  }

  /// Among the files that materials name; a new one for a URI that is not there yet.
  uint32_t measured_file(const JsonRef& uri) {
    const auto [at, is_new] = measured_.try_emplace(uri.as<std::string>(), uint32_t(all_.measured.size()));
    if (is_new) all_.measured.push_back(uri);
    return at->second;
  }

  const GltfSource& source_;
  GltfMaterials& all_;
  std::map<std::string, uint32_t> measured_;  // by URI
};

}  // namespace

GltfMaterials read_materials(const GltfSource& source) {
  GltfMaterials all;
  MaterialReader reader(source, all);
  for (size_t i = 0; i < source.model.materials.size(); ++i) all.materials.push_back(reader.read(i));
  all.materials.push_back({});
  return all;
}

}  // namespace alhazen
