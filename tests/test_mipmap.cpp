// Mip levels and how look-ups choose among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/mipmap.h"
#include "materials/phong.h"
#include "materials/texture.h"
#include "renderer/camera_ray.h"

namespace alhazen {
namespace {

TextureImage checker(int size) {
  std::vector<uint8_t> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) texels.push_back((x + y) % 2 ? 255 : 0);
  return {size, size, 1, std::move(texels)};
}

struct Table {
  std::vector<Texture> textures{Texture{.image = 0}};
  std::vector<TextureImage> images{checker(64)};
  TextureUse use{.texture = 0};

  explicit Table(ColorSpace space = ColorSpace::linear) { add_smaller_levels(images[0], space); }
  [[nodiscard]] float at(Vec2f uv, float footprint, float density = 1, ColorSpace space = ColorSpace::linear) const {
    const SurfaceInputs inputs{&uv, 1, {}, footprint, &density};
    return sample({&textures, &images}, use, space, inputs).rgb.r;
  }
};

TEST(Mipmaps, HalveDownToOneTexel) {
  TextureImage image{7, 3, 2, std::vector<uint16_t>(42, 1000)};
  add_smaller_levels(image, ColorSpace::srgb);
  EXPECT_EQ(image.levels, 3);  // 7 x 3, 3 x 1, 1 x 1
  EXPECT_EQ(texels_of_levels(7, 3), 25u);
  EXPECT_EQ(std::get<1>(image.samples), std::vector<uint16_t>(50, 1000));
}

TEST(Mipmaps, AverageColoursAsLightAndNumbersAsNumbers) {
  const Table linear(ColorSpace::linear), srgb(ColorSpace::srgb);
  EXPECT_NEAR(linear.at({0.3f, 0.3f}, 1), 0.5f, 0.003f);
  EXPECT_NEAR(srgb.at({0.3f, 0.3f}, 1, 1, ColorSpace::srgb), 0.5f, 0.005f);  // half of the light
}

TEST(Mipmaps, ArePickedByTheFootprintInTexels) {
  Table t;
  // Levels told apart by their values.
  std::vector<uint8_t>& samples = std::get<0>(t.images[0].samples);
  MipLevel level_at = MipLevel{64, 64}.next();
  for (int k = 1; k < t.images[0].levels; ++k, level_at = level_at.next())
    std::fill(samples.begin() + ptrdiff_t(level_at.first_texel), samples.end(), uint8_t(10 * k));
  const auto level = [&](float texels) { return t.at({0.5f, 0.5f}, texels / 64) * 25.5f; };
  EXPECT_NEAR(level(2), 1, 1e-4f);
  EXPECT_NEAR(level(8), 3, 1e-4f);
  EXPECT_NEAR(level(std::sqrt(32.0f)), 2.5f, 1e-4f);
  EXPECT_NEAR(level(1e30f), 6, 1e-4f);
  EXPECT_NEAR(t.at({0.5f, 0.5f}, 1, 8.0f / 64) * 25.5f, 3, 1e-4f);  // the density counts
  t.use.xx = 2, t.use.yy = 2;                                       // and KHR_texture_transform's scale
  EXPECT_NEAR(level(8), 4, 1e-4f);
  t.use.xx = t.use.yy = 1;
  t.textures[0].mipmaps = Mipmaps::nearest;
  EXPECT_NEAR(level(std::sqrt(32.0f) * 1.1f), 3, 1e-4f);
  t.textures[0].mipmaps = Mipmaps::none;
  EXPECT_NEAR(level(8), t.at({0.5f, 0.5f}, 0) * 25.5f, 1e-4f);
}

TEST(Mipmaps, AreLeftAloneWhereATexelCoversTheFootprint) {
  const Table t;
  Table bare;
  bare.images[0] = checker(64);
  for (float x = 0; x < 1; x += 0.013f) EXPECT_EQ(t.at({x, 0.4f}, 0.9f / 64), bare.at({x, 0.4f}, 0.9f / 64));
}

TEST(Mipmaps, AreNotForTheModelThatKnowsNoneEvenWhereALookUpIsShared) {
  const Table t;
  Material material;
  material.phong.diffuse = Rgb(1.0f), material.phong.diffuse_texture = t.use;
  const Vec2f uv{0.501f, 0.301f};
  const float density = 1;
  TextureLookup<float> lookup;
  const SurfaceInputs inputs{&uv, 1, {}, 8, &density, &lookup};
  const TextureTable table{&t.textures, &t.images};
  const float over_footprint = sample(table, t.use, ColorSpace::srgb, inputs).rgb.r;
  const float at_point = phong_bsdf(material, table, inputs).diffuse.r;
  EXPECT_EQ(at_point, t.at(uv, 0, 1, ColorSpace::srgb));
  EXPECT_GT(std::abs(at_point - over_footprint), 0.1f);
}

TEST(Cone, IsAsWideAsAPixel) {
  Camera camera;
  camera.yfov = 1;
  const Cone cone = camera_cone(camera, 100, 1);
  EXPECT_NEAR(cone.at(2).width, 2 * 2 * std::tan(0.5) / 100, 1e-6);
  EXPECT_NEAR(camera_cone(camera, 100, 4).spread, cone.spread / 2, 1e-7f);
  camera.kind = Camera::Kind::orthographic, camera.ymag = 3;
  EXPECT_NEAR(camera_cone(camera, 100, 1).at(1e6f).width, 0.06f, 1e-7f);
}

}  // namespace
}  // namespace alhazen
