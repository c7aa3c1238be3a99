#include "materials/texel_records.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "core/fork_join.h"
#include "materials/material.h"

namespace alhazen {
namespace {

struct Member {
  uint32_t image;
  ColorSpace space;
};

/// What a material looks up, and how its colours are encoded.
struct Role {
  const TextureUse* use;
  ColorSpace space;
};
std::array<Role, 5> roles(const Material& m) {
  return {{{&m.base_color_texture, ColorSpace::srgb},
           {&m.emissive_texture, ColorSpace::srgb},
           {&m.metallic_roughness_texture, ColorSpace::linear},
           {&m.normal_texture, ColorSpace::linear},
           {&m.occlusion_texture, ColorSpace::linear}}};
}

/// Whether a look-up of one finds its texels where one of the other does.
bool are_alike(const TextureUse& a, const TextureUse& b, std::span<const Texture> textures,
               std::span<const TextureImage> images) {
  const auto without_texture = [](TextureUse use) { return use.texture = kNone, use; };
  const auto without_image = [](Texture texture) { return texture.image = kNone, texture; };
  const Texture &of_a = textures[a.texture], &of_b = textures[b.texture];
  const TextureImage &in_a = images[of_a.image], &in_b = images[of_b.image];
  return without_texture(a) == without_texture(b) && without_image(of_a) == without_image(of_b) &&
         in_a.width == in_b.width && in_a.height == in_b.height && in_a.levels == in_b.levels;
}

bool can_be_laid(const TextureImage& image) {
  const auto* bytes = std::get_if<std::vector<uint8_t>>(&image.samples);
  return bytes && !bytes->empty() && !image.records && image.width > 0 && image.height > 0 && image.channels >= 1 &&
         image.channels <= 4;
}

/// Bytes of a record in sRGB come first, for they are decoded together.
struct Group {
  std::vector<Member> members;
  size_t bytes = 0, encoded_bytes = 0;

  void add(const Role& role, uint32_t image, const TextureImage& of) {
    const auto same = [&](const Member& m) { return m.image == image; };
    const size_t channels = size_t(of.channels), encoded = role.space == ColorSpace::srgb ? channels : 0;
    if (std::ranges::any_of(members, same) || bytes + channels > TexelRecords::kMostBytes ||
        encoded_bytes + encoded > TexelRecords::kMostEncoded)
      return;
    members.push_back({image, role.space}), bytes += channels, encoded_bytes += encoded;
  }
};

Group group_around(const Role& first, std::span<const Role> all, std::span<const Texture> textures,
                   std::span<const TextureImage> images) {
  Group group;
  for (const Role& role : all)
    if (const uint32_t image = textures[role.use->texture].image;
        can_be_laid(images[image]) && are_alike(*first.use, *role.use, textures, images))
      group.add(role, image, images[image]);
  return group;
}

/// Of all levels.
size_t texels_of(const TextureImage& image) {
  MipLevel level{image.width, image.height};
  for (int k = 1; k < image.levels; ++k) level = level.next();
  return level.next().first_texel;
}

template <size_t channels>
void copy_channels(const uint8_t* from, uint8_t* to, size_t stride, size_t texels) {
  for (size_t i = 0; i < texels; ++i, from += channels, to += stride) std::memcpy(to, from, channels);
}

void copy_texels(const TextureImage& image, size_t first, size_t last, size_t byte, TexelRecords& records) {
  const auto channels = size_t(image.channels);
  const uint8_t* from = std::get<std::vector<uint8_t>>(image.samples).data() + first * channels;
  uint8_t* to = records.data.get() + first * records.size + byte;
  constexpr std::array copy{copy_channels<1>, copy_channels<2>, copy_channels<3>, copy_channels<4>};
  copy[channels - 1](from, to, records.size, last - first);
}

/// Colours that are encoded keep their alpha as it is.
uint32_t encoded_bits(const TextureImage& image, ColorSpace space, size_t first_byte) {
  const unsigned colors = space == ColorSpace::srgb ? (image.channels < 3 ? 1 : 3) : 0;
  return ((1u << colors) - 1) << first_byte;
}

void lay(const Group& group, std::vector<TextureImage>& images) {
  constexpr size_t kWorthATask = 4096;  // texels: their records stay in the cache
  const TextureImage& first_image = images[group.members.front().image];
  const size_t texels = texels_of(first_image);
  const auto records = std::make_shared<TexelRecords>(group.bytes, texels);
  std::vector<size_t> first_byte;
  for (size_t byte = 0; const Member& m : group.members) {
    first_byte.push_back(byte), byte += size_t(images[m.image].channels);
    records->encoded |= encoded_bits(images[m.image], m.space, first_byte.back());
  }
  const ForkJoin order;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, texels, kWorthATask),
                    order.task([&](const tbb::blocked_range<size_t>& some) {
                      for (size_t k = 0; k < group.members.size(); ++k)
                        copy_texels(images[group.members[k].image], some.begin(), some.end(), first_byte[k], *records);
                    }));
  for (size_t k = 0; k < group.members.size(); ++k) {
    TextureImage& image = images[group.members[k].image];
    image.samples = {}, image.records = records;
    image.first_byte = first_byte[k], image.space = group.members[k].space;
  }
}

}  // namespace

void lay_side_by_side(std::span<const Material> materials, std::span<const Texture> textures,
                      std::vector<TextureImage>& images, uint64_t spare) {
  if (!kMixesRecords) return;
  const auto is_free = [&](const Role& role) {
    if (role.use->texture >= textures.size()) return false;
    const uint32_t image = textures[role.use->texture].image;
    return image < images.size() && can_be_laid(images[image]);
  };
  for (const Material& material : materials) {
    if (material.model != ShadingModel::metallic_roughness) continue;
    std::vector<Role> left;
    for (const Role& role : roles(material))
      if (is_free(role)) left.push_back(role);
    for (const Role& first : left) {
      if (!is_free(first)) continue;
      const Group group = group_around(first, left, textures, images);
      if (group.members.size() < 2 || group.bytes < TexelRecords::kLeastBytes) continue;
      if (texels_of(images[group.members[0].image]) * group.bytes <= spare) lay(group, images);
    }
  }
}

}  // namespace alhazen
