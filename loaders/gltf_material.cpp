#include "loaders/gltf_material.h"

#include <array>

#include "loaders/gltf_layers.h"

namespace alhazen {
namespace {

// ---- Textures ----

Rgb rgb(const std::vector<double>& c) { return {float(c[0]), float(c[1]), float(c[2])}; }

class MaterialReader {
 public:
  MaterialReader(const GltfSource& source, GltfMaterials& all) : source_(source), all_(all) {
    all_.uses_texture.resize(source.model.textures.size());
  }

  Material read(size_t i) {
    const JsonRef r = source_.at("materials", i);
    Material m;
    read_core(source_.model.materials[i], r, m);
    if (const auto e = r.extension("KHR_materials_pbrSpecularGlossiness")) read_specular_glossiness(*e, m);
    read_khronos(r, m);
    if (const auto phong = r.extension("ALHAZEN_materials_phong")) {
      m.model = ShadingModel::phong;
      read_phong(*phong, m.phong);
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

  void read_core(const tinygltf::Material& in, const JsonRef& r, Material& m) {
    const tinygltf::PbrMetallicRoughness& pbr = in.pbrMetallicRoughness;
    m.name = in.name;
    m.alpha_mode = in.alphaMode == "MASK"    ? AlphaMode::mask
                   : in.alphaMode == "BLEND" ? AlphaMode::blend
                                             : AlphaMode::opaque;
    m.alpha_cutoff = float(in.alphaCutoff);
    m.double_sided = in.doubleSided;
    m.base_color = {rgb(pbr.baseColorFactor), float(pbr.baseColorFactor[3])};
    m.metallic = float(pbr.metallicFactor);
    m.roughness = float(pbr.roughnessFactor);
    if (const auto p = r.find("pbrMetallicRoughness")) {
      m.base_color_texture = texture_use(*p, "baseColorTexture");
      m.metallic_roughness_texture = texture_use(*p, "metallicRoughnessTexture");
    }
    m.normal_texture = texture_use(r, "normalTexture");
    m.normal_scale = float(in.normalTexture.scale);
    m.occlusion_texture = texture_use(r, "occlusionTexture");
    m.occlusion_strength = float(in.occlusionTexture.strength);
    m.emissive = rgb(in.emissiveFactor);
    m.emissive_texture = texture_use(r, "emissiveTexture");
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

  const GltfSource& source_;
  GltfMaterials& all_;
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
