// Claims about images whose texels lie side by side: what is looked up has the bits that it has in images apart.
#include "materials/texel_records.h"

#include <gtest/gtest.h>

#include <cstring>

#include "materials/material.h"
#include "materials/mipmap.h"
#include "tests/uniform.h"

namespace alhazen {
namespace {

using F = ShadingLanes;

TextureImage random_image(Uniform& uniform, int width, int height, bool mipmaps) {
  TextureImage image{.width = width, .height = height, .channels = 1 + int(uniform.bits() % 4), .samples = {}};
  std::vector<uint8_t> samples(size_t(width) * size_t(height) * size_t(image.channels));
  for (uint8_t& sample : samples) sample = uint8_t(uniform.bits());
  image.samples = samples;
  if (mipmaps) add_smaller_levels(image, ColorSpace::linear);
  return image;
}

struct Look {
  TextureUse Material::*use;
  ColorSpace space;
};
constexpr Look kLooks[] = {{&Material::base_color_texture, ColorSpace::srgb},
                           {&Material::emissive_texture, ColorSpace::srgb},
                           {&Material::metallic_roughness_texture, ColorSpace::linear},
                           {&Material::normal_texture, ColorSpace::linear},
                           {&Material::occlusion_texture, ColorSpace::linear},
                           {&Material::occlusion_texture, ColorSpace::srgb}};  // as no material has it

/// A material with five textures, mostly used alike.
struct Textured {
  Material material;
  std::vector<Texture> textures;
  std::vector<TextureImage> images;

  explicit Textured(Uniform& uniform) {
    const auto rarely = [&] { return uniform.bits() % 12 == 0; };
    const auto wrap = [&] { return Wrap(uniform.bits() % 3); };
    Texture sampler{.wrap_u = wrap(), .wrap_v = wrap()};
    sampler.nearest = uniform.bits() % 4 == 0, sampler.nearest_small = uniform.bits() % 4 == 0;
    sampler.mipmaps = Mipmaps(uniform.bits() % 3);
    const int width = 1 + int(uniform.bits() % 37), height = 1 + int(uniform.bits() % 23);
    const bool mipmaps = uniform.bits() % 4 != 0;
    const TextureUse alike{0, 0, uniform(-3, 3), uniform(-1, 1), uniform(-2, 2), uniform(-1, 1), uniform(-3, 3), 0.5f};
    for (uint32_t i = 0; i < 5; ++i) {
      images.push_back(random_image(uniform, rarely() ? 5 : width, height, mipmaps));
      textures.push_back(sampler), textures[i].image = rarely() ? 0 : i;
      if (rarely()) textures[i].wrap_u = wrap();
      TextureUse& use = material.*kLooks[i].use;
      use = alike, use.texture = rarely() ? kNone : i;
      if (rarely()) use.x0 = 0;
    }
  }
  [[nodiscard]] TextureTable table() const { return {&textures, &images}; }
};

struct Bits {
  std::array<LaneArray<F>, 4> of;  // r, g, b, a
  explicit Bits(const BasicRgba<F>& c) {
    of[0].store(c.rgb.r), of[1].store(c.rgb.g), of[2].store(c.rgb.b), of[3].store(c.a);
  }
  [[nodiscard]] std::array<float, 4> lane(size_t k) const { return {of[0][k], of[1][k], of[2][k], of[3][k]}; }
};

bool same_bits(const std::array<float, 4>& a, const std::array<float, 4>& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

TEST(TexelRecords, AreLookedUpAsImagesApart) {
  Uniform uniform(11);
  int laid = 0;
  for (int i = 0; i < 1500; ++i) {
    const Textured apart(uniform);
    Textured together = apart;
    lay_side_by_side({&together.material, 1}, together.textures, together.images);
    for (const TextureImage& image : together.images) laid += image.records != nullptr;
    LaneArray<F> u, v, footprint, density;
    for (size_t k = 0; k < kWidthOf<F>; ++k) {
      u[k] = uniform(-3, 3), v[k] = k == 3 ? NAN : uniform(-100, 100);
      footprint[k] = k % 4 ? std::exp2(uniform(-12, 8)) : 0, density[k] = uniform(0, 2);
    }
    const Vec2<F> uv{u.load(), v.load()};
    const F per_metre = density.load();
    TextureLookup<F> lookup, other;
    BasicSurfaceInputs<F> inputs{&uv, 1, {}, footprint.load(), &per_metre, &lookup};
    std::array<const TextureUse*, 5> uses;
    for (size_t k = 0; k < uses.size(); ++k) uses[k] = &(together.material.*kLooks[k].use);
    if (i % 2) prefetch(together.table(), uses, inputs);
    for (const Look& look : kLooks) {
      inputs.lookup = &lookup;
      const Bits found(sample(together.table(), together.material.*look.use, look.space, inputs));
      inputs.lookup = i % 3 ? &other : nullptr;
      const Bits expected(sample(apart.table(), apart.material.*look.use, look.space, inputs));
      inputs.lookup = nullptr;
      const Bits alone(sample(together.table(), together.material.*look.use, look.space, inputs));
      for (size_t k = 0; k < kWidthOf<F>; ++k) {
        ASSERT_TRUE(same_bits(found.lane(k), expected.lane(k)) && same_bits(alone.lane(k), expected.lane(k)))
            << i << " " << k;
        const Vec2f at{u[k], v[k]};
        const Rgba one = sample(together.table(), together.material.*look.use, look.space,
                                SurfaceInputs{&at, 1, {}, footprint[k], &density[k]});
        ASSERT_TRUE(same_bits({one.rgb.r, one.rgb.g, one.rgb.b, one.a}, expected.lane(k))) << i << " " << k;
      }
    }
  }
  EXPECT_GE(laid, kMixesRecords ? 1500 : 0);
}

TEST(TexelRecords, LeaveWhatDiffersInImagesOfTheirOwn) {
  if (!kMixesRecords) GTEST_SKIP() << "lanes are not wide enough";
  std::vector<TextureImage> images;
  for (int i = 0; i < 6; ++i)
    images.push_back({.width = 2, .height = 2, .channels = 3, .samples = std::vector<uint8_t>(12)});
  images[3].samples = std::vector<uint16_t>(12);
  images[4].width = 1, images[4].samples = std::vector<uint8_t>(6);
  std::vector<Texture> textures;
  for (uint32_t i = 0; i < 6; ++i) textures.push_back({.image = i});
  std::vector<Material> materials(2);
  materials[0].base_color_texture.texture = 0, materials[0].normal_texture.texture = 1;
  materials[0].metallic_roughness_texture.texture = 2, materials[0].occlusion_texture.texture = 3;
  materials[0].emissive_texture.texture = 4;
  materials[1].base_color_texture.texture = 0, materials[1].normal_texture.texture = 5;  // one is taken
  lay_side_by_side(materials, textures, images, 35);
  EXPECT_FALSE(images[0].records) << "36 bytes do not fit";
  lay_side_by_side(materials, textures, images, 36);
  const TexelRecords* const records = images[0].records.get();
  ASSERT_TRUE(records);
  EXPECT_EQ(records->size, 9u);
  EXPECT_EQ(records->encoded, 0b111u);
  EXPECT_TRUE(images[1].records.get() == records && images[2].records.get() == records);
  for (size_t i = 3; i < 6; ++i) EXPECT_FALSE(images[i].records) << i;
}

}  // namespace
}  // namespace alhazen
