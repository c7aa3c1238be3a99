#include "loaders/gltf_material.h"

#include <array>
#include <cmath>

#include "loaders/gltf_uri.h"

namespace alhazen {
namespace {

// ---- Textures ----

Wrap wrap_of(int mode) {
  return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp_to_edge
         : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat
                                                         : Wrap::repeat;
}

/// KHR_texture_transform: translation * rotation * scale; angles turn from v to u, for v points down.
void set_transform(const JsonRef& r, TextureUse& use) {
  const auto offset = r.get("offset", std::array{0.0, 0.0}), scale = r.get("scale", std::array{1.0, 1.0});
  const double angle = r.get("rotation", 0.0), c = std::cos(angle), s = std::sin(angle);
  use.uv_set = r.get("texCoord", use.uv_set);
  use.xx = float(c * scale[0]), use.xy = float(s * scale[1]), use.x0 = float(offset[0]);
  use.yx = float(-s * scale[0]), use.yy = float(c * scale[1]), use.y0 = float(offset[1]);
}

/// The textureInfo `key` of `owner`; unused where there is none.
TextureUse texture_use(const JsonRef& owner, const char* key) {
  TextureUse use;
  if (const auto info = owner.find(key)) {
    use.texture = (*info)["index"].as<uint32_t>();
    use.uv_set = info->get("texCoord", 0u);
    if (const auto transform = info->extension("KHR_texture_transform")) set_transform(*transform, use);
  }
  return use;
}

// ---- Materials ----

Rgb rgb(const std::vector<double>& c) { return {float(c[0]), float(c[1]), float(c[2])}; }

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
  if (const auto e = r.extension("KHR_materials_specular")) {
    m.specular = e->get("specularFactor", m.specular);
    m.specular_texture = texture_use(*e, "specularTexture");
    m.specular_color = e->get("specularColorFactor", m.specular_color);
    m.specular_color_texture = texture_use(*e, "specularColorTexture");
  }
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
}

Bytes read_image(GltfSource& source, const GltfBuffers& buffers, const JsonRef& r) {
  if (const auto view = r.find("bufferView")) {
    const std::span<const uint8_t> bytes = buffers.buffer_view(view->as<int>());
    return {bytes.begin(), bytes.end()};
  }
  const auto uri = r.find("uri");
  if (!uri) {
    source.warn(r.pointer(), "has neither `uri` nor `bufferView`, taken as white");
    return {};
  }
  auto bytes = resolve_uri(*uri, source.document.folder);
  if (!bytes) source.warn(uri->pointer(), "cannot read `" + uri->as<std::string>().substr(0, 80) + "`, taken as white");
  return bytes ? std::move(*bytes) : Bytes{};
}

}  // namespace

std::vector<EncodedImage> read_images(GltfSource& source, const GltfBuffers& buffers) {
  std::vector<EncodedImage> images;
  for (const JsonRef& r : source.root().elements("images"))
    images.push_back({source.document.json.file + ": " + r.pointer(), read_image(source, buffers, r)});
  return images;
}

std::vector<Texture> read_textures(const GltfSource& source) {
  std::vector<Texture> textures;
  for (const tinygltf::Texture& in : source.model.textures) {
    Texture t;
    if (in.source >= 0) t.image = uint32_t(in.source);
    if (in.sampler >= 0) {
      const tinygltf::Sampler& sampler = source.model.samplers[size_t(in.sampler)];
      t.wrap_u = wrap_of(sampler.wrapS);
      t.wrap_v = wrap_of(sampler.wrapT);
      t.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    textures.push_back(t);
  }
  return textures;
}

std::vector<Material> read_materials(const GltfSource& source) {
  std::vector<Material> materials(source.model.materials.size() + 1);
  for (size_t i = 0; i + 1 < materials.size(); ++i) {
    const JsonRef r = source.at("materials", i);
    read_core(source.model.materials[i], r, materials[i]);
    read_khronos(r, materials[i]);
    if (const auto phong = r.extension("ALHAZEN_materials_phong")) {
      materials[i].model = ShadingModel::phong;
      read_phong(*phong, materials[i].phong);
    }
  }
  return materials;
}

}  // namespace alhazen
