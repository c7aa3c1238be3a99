// Environments given as cubes and spherical harmonics, and EXT_lights_image_based that brings them.
#include "renderer/cube_environment.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "decide.h"
#include "gltf_builder.h"

namespace alhazen {
namespace {

constexpr double kPi = std::numbers::pi;

CubeImage cube_of(int size, const std::function<Rgb(int face, int x, int y)>& color) {
  CubeImage cube;
  for (int f = 0; f < 6; ++f) {
    ColorImage& face = cube.faces[size_t(f)];
    face = {size, size, {"R", "G", "B"}, {}};
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const Rgb c = color(f, x, y);
        face.pixels.insert(face.pixels.end(), {c.r, c.g, c.b});
      }
  }
  return cube;
}

std::array<Rgb, 9> irradiance_of(std::initializer_list<float> grey) {
  std::array<Rgb, 9> all{};
  std::transform(grey.begin(), grey.end(), all.begin(), [](float g) { return Rgb{g}; });
  return all;
}

Vec3f random_direction(Rng& rng) { return normalize(Vec3f(uniform_vector(rng, -1, 1))); }

TEST(CubeEnvironment, OfOneColourIsThatColourForEveryLobe) {
  // Radiance L has the irradiance pi L: pi L sqrt(4 pi) of the first harmonic.
  const float harmonic = float(0.5 * kPi * std::sqrt(4 * kPi));
  const CubeImage level = cube_of(8, [](int, int, int) { return Rgb{0.5f}; });
  const Environment environment = make_environment(std::vector{level, level, level}, irradiance_of({harmonic}));
  Rng rng(1);
  for (int k = 0; k < 100; ++k) {
    const Vec3f d = random_direction(rng);
    EXPECT_NEAR(environment_radiance(environment, d, float(uniform(rng, 0, 1))).g, 0.5f, 1e-5f);
    EXPECT_NEAR(environment_diffuse(environment, d).g, 0.5f, 1e-5f);
  }
}

TEST(CubeEnvironment, IrradianceOfASkyThatGrowsWithTheCosineIsExact) {
  // Radiance 1 + cos to +y: harmonics sqrt(4 pi) and sqrt(4 pi / 3); a cosine lobe keeps pi and 2 pi / 3 of them, so
  // that E / pi = 1 + 2/3 n.y.
  const float e0 = float(kPi * std::sqrt(4 * kPi)), e1 = float(2 * kPi / 3 * std::sqrt(4 * kPi / 3));
  const CubeImage level = cube_of(2, [](int, int, int) { return Rgb{1.0f}; });
  const Environment environment = make_environment(std::vector{level}, irradiance_of({e0, e1}));
  Rng rng(2);
  for (int k = 0; k < 100; ++k) {
    const Vec3f n = random_direction(rng);
    EXPECT_NEAR(environment_diffuse(environment, n).r, 1 + 2 / 3.0f * n.y, 1e-5f);
  }
}

TEST(CubeEnvironment, FacesLookAlongTheAxesUpsideDown) {
  // From the middle of each face a quarter to its right, and a quarter down.
  const Vec3f middle[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const Vec3f right[] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  const Vec3f down[] = {{0, 1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}};
  const CubeImage cube = cube_of(4, [](int f, int x, int y) { return Rgb{float(f), float(x), float(y)}; });
  for (int f = 0; f < 6; ++f) {
    const Rgb c = cube_radiance(cube, middle[f] + right[f] * 0.75f + down[f] * 0.25f);
    EXPECT_NEAR(c.r, float(f), 1e-5f);
    EXPECT_NEAR(c.g, 3, 1e-5f);
    EXPECT_NEAR(c.b, 2, 1e-5f);
  }
}

TEST(CubeEnvironment, NeighbouringFacesMeetWithoutASeam) {
  const auto radiance = [](const Vec3f& d) { return Rgb{d.x, d.y, d.z}; };
  // What each pixel of a face looks at, by its place in the cube.
  CubeImage cube = cube_of(64, [](int, int, int) { return Rgb{0.0f}; });
  const Vec3f right[] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  const Vec3f down[] = {{0, 1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}};
  for (size_t f = 0; f < 6; ++f) {
    const Vec3f middle{f == 0   ? 1.0f
                       : f == 1 ? -1.0f
                                : 0,
                       f == 2   ? 1.0f
                       : f == 3 ? -1.0f
                                : 0,
                       f == 4   ? 1.0f
                       : f == 5 ? -1.0f
                                : 0};
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const Rgb c = radiance(
            normalize(middle + right[f] * ((float(x) + 0.5f) / 32 - 1) + down[f] * ((float(y) + 0.5f) / 32 - 1)));
        float* p = cube.faces[f].at(x, y);
        p[0] = c.r, p[1] = c.g, p[2] = c.b;
      }
  }
  const Environment environment = make_environment(std::vector{cube}, {});
  Rng rng(3);
  for (int k = 0; k < 1000; ++k) {
    const Vec3f d = random_direction(rng);
    const Rgb c = environment_radiance(environment, d, 0);
    EXPECT_LT(length(Vec3f{c.r, c.g, c.b} - d), 0.02f);
  }
}

// ---- In glTF ----

/// A picture of one colour, 8 bits.
void write_png(const std::filesystem::path& file, int width, int height, const std::vector<uint8_t>& pixel) {
  const auto out = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(width, height, int(pixel.size()), OIIO::TypeDesc::UINT8);
  if (pixel.size() == 4) spec.attribute("oiio:UnassociatedAlpha", 1), spec.alpha_channel = 3;
  std::vector<uint8_t> pixels;
  for (int i = 0; i < width * height; ++i) pixels.insert(pixels.end(), pixel.begin(), pixel.end());
  ASSERT_TRUE(out && out->open(file.string(), spec) && out->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
              out->close());
}

/// A light of one level whose face at +x has its own image, the others the other.
json lit_by_images(json more = {}) {
  json light = {
      {"specularImageSize", 4}, {"specularImages", {{1, 0, 0, 0, 0, 0}}}, {"irradianceCoefficients", json::array()}};
  for (int k = 0; k < 9; ++k) light["irradianceCoefficients"].push_back({k == 0 ? 1.0 : 0.0, 0.0, k == 1 ? 1.0 : 0.0});
  if (!more.is_null()) light.update(more);
  return {{"asset", {{"version", "2.0"}}},
          {"extensionsUsed", {"EXT_lights_image_based"}},
          {"extensions", {{"EXT_lights_image_based", {{"lights", {light}}}}}},
          {"images", {{{"uri", "all.png"}}, {{"uri", "right.png"}}}},
          {"scenes", {{{"extensions", {{"EXT_lights_image_based", {{"light", 0}}}}}}}},
          {"scene", 0}};
}

class ImageBasedLight : public testing::Test {
 protected:
  void SetUp() override {
    write_png(folder_ / "all.png", 4, 4, {0, 0, 0});
    write_png(folder_ / "right.png", 4, 4, {188, 255, 0, 51});  // RGBD: sRGB 188 is 0.5, and alpha 1/5
  }
  Loaded load(const json& document) { return load_file(folder_.write("scene.gltf", document.dump())); }

  TemporaryFolder folder_;
};

TEST_F(ImageBasedLight, IsTheScenesEnvironment) {
  const Loaded loaded = load(lit_by_images({{"intensity", 2}}));
  ASSERT_TRUE(loaded.scene().environment);
  EXPECT_EQ(loaded.warnings, std::vector<std::string>{});
  const Environment& environment = *loaded.scene().environment;
  EXPECT_TRUE(environment.seen);
  const Rgb right = environment_radiance(environment, {1, 0, 0}, 0);
  EXPECT_NEAR(right.r, 2 * 0.5f * 5, 0.05f);
  EXPECT_NEAR(right.g, 2 * 5, 1e-4f);
  EXPECT_EQ(environment_radiance(environment, {-1, 0, 0}, 0), Rgb{0.0f});
  // Irradiance E00 Y00 over pi, and of blue E1-1 Y1-1.
  EXPECT_NEAR(environment_diffuse(environment, {1, 0, 0}).r, 2 * 0.282095 / kPi, 1e-5);
  EXPECT_NEAR(environment_diffuse(environment, {0, 1, 0}).b, 2 * 0.488603 / kPi, 1e-5);
}

TEST_F(ImageBasedLight, TurnsWithItsRotation) {
  const double s = std::sqrt(0.5);  // a quarter about y: what was at +x is at -z
  const Loaded loaded = load(lit_by_images({{"rotation", {0, s, 0, s}}}));
  EXPECT_GT(environment_radiance(*loaded.scene().environment, {0, 0, -1}, 0).g, 4);
  EXPECT_LT(environment_radiance(*loaded.scene().environment, {1, 0, 0}, 0).g, 0.01f);
}

TEST_F(ImageBasedLight, IsAbsentWhereTheSceneNamesNone) {
  json document = lit_by_images();
  document["scenes"][0].erase("extensions");
  EXPECT_FALSE(load(document).scene().environment);
}

TEST_F(ImageBasedLight, WithoutAnImageWarnsAndGivesNoLight) {
  std::filesystem::remove(folder_ / "right.png");
  const Loaded loaded = load(lit_by_images());
  EXPECT_FALSE(loaded.scene().environment);
  ASSERT_FALSE(loaded.warnings.empty());
  EXPECT_NE(loaded.warnings.back().find("/extensions/EXT_lights_image_based/lights/0/specularImages/0/0"),
            std::string::npos);
}

TEST_F(ImageBasedLight, RefusesFacesThatAreNotSquareAndOfOneSize) {
  write_png(folder_ / "right.png", 4, 2, {1, 2, 3});
  const std::string light = "/extensions/EXT_lights_image_based/lights/0/";
  const auto error = [&](const json& document) { return error_of_file(folder_.write("scene.gltf", document.dump())); };
  EXPECT_EQ(error(lit_by_images()), light + "specularImages/0/0: expected an image of 4 x 4 pixels, found 4 x 2");
  EXPECT_EQ(error(lit_by_images({{"specularImages", {{0, 0, 0}}}})),
            light + "specularImages/0: expected an array of 6 images, found [0,0,0]");
  EXPECT_EQ(error(lit_by_images({{"irradianceCoefficients", json::array({{1, 2, 3}})}})),
            light + "irradianceCoefficients: expected an array of 9 colours, found [[1,2,3]]");
  EXPECT_EQ(error(lit_by_images({{"intensity", -1}})), light + "intensity: expected a finite number >= 0, found -1");
}

}  // namespace
}  // namespace alhazen
