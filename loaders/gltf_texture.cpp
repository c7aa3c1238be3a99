#include "loaders/gltf_texture.h"

#include <array>

#include "loaders/gltf_uri.h"
#include "loaders/image_ktx.h"

namespace alhazen {
namespace {

Wrap wrap_of(int mode) {
  return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp_to_edge
         : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat
                                                         : Wrap::repeat;
}

/// The image to decode; kNone: there is none that can be.
uint32_t image_of(const JsonRef& texture) {
  for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp", "MSFT_texture_dds"}) {
    const auto e = texture.extension(name);
    if (!e || !e->has("source") || (name == std::string_view("KHR_texture_basisu") && !kDecodesKtx)) continue;
    return (*e)["source"].as<uint32_t>();
  }
  return texture.get("source", kNone);
}

void set_minification(int mode, Texture& t) {
  t.nearest_small = mode == TINYGLTF_TEXTURE_FILTER_NEAREST || mode == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
                    mode == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
  if (mode == TINYGLTF_TEXTURE_FILTER_NEAREST || mode == TINYGLTF_TEXTURE_FILTER_LINEAR)
    t.mipmaps = Mipmaps::none;
  else if (mode == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
           mode == TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST)
    t.mipmaps = Mipmaps::nearest;
}

Texture read_texture(const GltfSource& source, const JsonRef& r) {
  Texture t;
  t.image = image_of(r);
  if (const auto index = r.find("sampler")) {
    const tinygltf::Sampler& sampler = source.model.samplers[index->as<size_t>()];
    t.wrap_u = wrap_of(sampler.wrapS);
    t.wrap_v = wrap_of(sampler.wrapT);
    t.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    set_minification(sampler.minFilter, t);
  }
  return t;
}

/// Once for all KTX 2 textures.
void warn_of_missing_image(GltfSource& source, const JsonRef& texture) {
  if (texture.extension("KHR_texture_basisu"))
    source.warn("/textures",
                "those of KHR_texture_basisu alone are left out: their KTX 2 images need a build with libktx");
  else
    source.warn(texture.pointer(), "left out: it has no image that can be decoded here");
}

/// Tells the images which mip levels their textures want. Phong's are sampled without.
void mark_mipmaps(const GltfMaterials& materials, GltfTextures& all) {
  for (const Texture& t : all.textures)
    if (t.image != kNone && t.mipmaps != Mipmaps::none) all.images[t.image].mipmaps = true;
  const auto mark_color = [&](const TextureUse& use) {
    if (!use || all.textures[use.texture].image == kNone) return;
    all.images[all.textures[use.texture].image].space = ColorSpace::srgb;
  };
  for (const Material& m : materials.materials)
    for (const TextureUse& use : {m.base_color_texture, m.emissive_texture, m.specular_color_texture,
                                  m.sheen.color_texture, m.diffuse_transmission.color_texture})
      mark_color(use);
}

}  // namespace

Bytes read_image(GltfSource& source, const GltfBuffers& buffers, const JsonRef& r) {
  if (const auto view = r.find("bufferView")) {
    const std::span<const uint8_t> bytes = buffers.buffer_view(view->as<int>());
    source.budget->take(r, bytes.size());
    return {bytes.begin(), bytes.end()};
  }
  const auto uri = r.find("uri");
  if (!uri) {
    source.warn(r.pointer(), "has neither `uri` nor `bufferView`, taken as white");
    return {};
  }
  auto bytes = resolve_uri(*uri, source.document.folder, *source.budget);
  if (!bytes) source.warn(uri->pointer(), "cannot read `" + uri->as<std::string>().substr(0, 80) + "`, taken as white");
  return bytes ? std::move(*bytes) : Bytes{};
}

GltfTextures read_textures(GltfSource& source, const GltfBuffers& buffers, const GltfMaterials& materials) {
  GltfTextures all;
  const auto textures = source.root().elements("textures"), images = source.root().elements("images");
  std::vector<char> used(images.size());
  for (size_t i = 0; i < textures.size(); ++i) {
    all.textures.push_back(read_texture(source, textures[i]));
    const uint32_t image = all.textures[i].image;
    if (!materials.uses_texture[i]) continue;
    if (image == kNone)
      warn_of_missing_image(source, textures[i]);
    else
      used[image] = 1;
  }
  for (size_t i = 0; i < images.size(); ++i)
    all.images.push_back({source.document.json.file + ": " + images[i].pointer(),
                          used[i] ? read_image(source, buffers, images[i]) : Bytes{}});
  for (const RoughnessTexture& made : materials.roughness) {
    Texture texture = all.textures[made.glossiness_texture];
    EncodedImage image;
    image.glossiness_of = texture.image, image.glossiness_factor = made.factor;
    texture.image = uint32_t(all.images.size());
    all.textures.push_back(texture);
    all.images.push_back(std::move(image));
  }
  mark_mipmaps(materials, all);
  return all;
}

}  // namespace alhazen
