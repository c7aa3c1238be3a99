// Claims about picture files: read again by OpenImageIO they hold what was written, and they are complete or not there.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <random>

#include "core/error.h"
#include "loaders/image_file.h"
#include "loaders/image_library.h"
#include "loaders/part_file.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

class ImageFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("alhazen-test-" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path file(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] size_t files() const {
    return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

 private:
  fs::path folder_;
};

struct ReadBack {
  OIIO::ImageSpec spec;
  std::vector<float> pixels;
};

/// As the file stores them: alpha is neither multiplied in nor out.
ReadBack read(const fs::path& file) {
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  const auto in = OIIO::ImageInput::open(file.string(), &config);
  if (!in) throw std::runtime_error(OIIO::geterror());
  ReadBack image{in->spec(), {}};
  image.pixels.resize(size_t(image.spec.width) * size_t(image.spec.height) * size_t(image.spec.nchannels));
  in->read_image(0, 0, 0, image.spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data());
  return image;
}

/// Random, colour premultiplied by an alpha of 0, 1 or between.
ColorImage random_image(int width, int height, float brightest) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<float> u(0, 1);
  ColorImage image{width, height, {"R", "G", "B", "A"}, {}};
  for (int i = 0; i < width * height; ++i) {
    const float alpha = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 1.0f : 0.25f + 0.5f * u(rng);
    for (int c = 0; c < 3; ++c) image.pixels.push_back(brightest * u(rng) * alpha);
    image.pixels.push_back(alpha);
  }
  return image;
}

float srgb(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

TEST_F(ImageFile, ExrHoldsTheVeryFloats) {
  const ColorImage image = random_image(67, 41, 1e4f);
  for (const std::string compression : {"", "none", "rle", "zips", "zip", "piz"}) {
    write_image(file("a.exr"), image, {.compression = compression}, {});
    const ReadBack back = read(file("a.exr"));
    EXPECT_EQ(back.spec.channelnames, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(back.spec.format, OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(back.pixels, image.pixels) << compression;
    EXPECT_EQ(back.spec.get_string_attribute("compression"), compression.empty() ? "zip" : compression);
  }
}

TEST_F(ImageFile, HalfFloatsAreNearAndNeverInfinite) {
  ColorImage image = random_image(33, 20, 10);
  image.pixels[4] = 1e9f, image.pixels[5] = 65504;
  for (const std::string compression : {"zip", "none", "piz"}) {
    write_image(file("a.exr"), image, {.half = true, .compression = compression}, {});
    const ReadBack back = read(file("a.exr"));
    EXPECT_EQ(back.spec.format, OIIO::TypeDesc::HALF);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      const float expected = std::min(image.pixels[i], 65504.0f);
      ASSERT_NEAR(back.pixels[i], expected, expected / 2048 + 1e-7f);  // 11 bits
    }
  }
}

TEST_F(ImageFile, EightBitFormatsHoldEncodedColourStraightOrPremultiplied) {
  const ColorImage image = random_image(50, 30, 1.5f);
  for (const auto& [name, premultiplied] : {std::pair("a.png", false), {"a.tga", false}, {"a.tif", true}}) {
    write_image(file(name), image, {}, {});
    const ReadBack back = read(file(name));
    ASSERT_EQ(back.spec.nchannels, 4) << name;
    EXPECT_EQ(back.spec.format, OIIO::TypeDesc::UINT8) << name;
    for (size_t i = 0; i < image.pixels.size(); i += 4) {
      const float alpha = image.pixels[i + 3];
      for (size_t c = 0; c < 3; ++c) {
        const float straight = srgb(std::min(1.0f, alpha > 0 ? image.pixels[i + c] / alpha : 0.0f));
        ASSERT_NEAR(back.pixels[i + c], premultiplied ? straight * alpha : straight, 0.51f / 255) << name;
      }
      ASSERT_NEAR(back.pixels[i + 3], alpha, 0.51f / 255) << name;
    }
  }
}

TEST_F(ImageFile, FormatsWithoutAlphaHoldThreeChannels) {
  ColorImage image{64, 64, {"R", "G", "B", "A"}, {}};
  for (int i = 0; i < 64 * 64; ++i) image.pixels.insert(image.pixels.end(), {0.2f, 0.5f, 0.8f, 1.0f});
  for (const char* name : {"a.jpg", "a.hdr", "a.ppm"}) {
    write_image(file(name), image, {}, {});
    const ReadBack back = read(file(name));
    ASSERT_EQ(back.spec.nchannels, 3) << name;
    const bool linear = image_format(name).linear;
    for (size_t i = 0; i < back.pixels.size(); ++i)
      ASSERT_NEAR(back.pixels[i], linear ? image.pixels[i % 3] : srgb(image.pixels[i % 3]), 2.0f / 255) << name;
  }
}

TEST_F(ImageFile, ExrHoldsIdsAsUnsignedIntegers) {
  IdImage image{31, 17, {"node", "primitive", "material"}, {}};
  for (uint32_t i = 0; i < 31 * 17 * 3; ++i) image.pixels.push_back(i % 7 == 0 ? 0xffffffffu : i * 2654435761u);
  write_image(file("a.exr"), image, {}, {});
  const auto in = OIIO::ImageInput::open(file("a.exr").string());
  ASSERT_TRUE(in);
  EXPECT_EQ(in->spec().format, OIIO::TypeDesc::UINT32);
  EXPECT_EQ(in->spec().nchannels, 3);
  std::vector<uint32_t> pixels(image.pixels.size());
  ASSERT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT32, pixels.data()));
  for (int c = 0; c < 3; ++c) {  // OpenEXR sorts channels by name
    const auto from = std::find(image.channels.begin(), image.channels.end(), in->spec().channelnames[size_t(c)]);
    ASSERT_NE(from, image.channels.end());
    for (size_t i = 0; i < pixels.size(); i += 3)
      ASSERT_EQ(pixels[i + size_t(c)], image.pixels[i + size_t(from - image.channels.begin())]);
  }
}

TEST_F(ImageFile, MetadataReadsBack) {
  const Metadata metadata{{"Software", "Alhazen test"}, {"ImageDescription", "a scene"}, {"alhazen:samples", "16"}};
  for (const char* name : {"a.exr", "a.png", "a.tif", "a.jpg"}) {
    write_image(file(name), random_image(8, 8, 1), {}, metadata);
    const OIIO::ImageSpec spec = read(file(name)).spec;
    EXPECT_EQ(spec.get_string_attribute("Software"), "Alhazen test") << name;
    EXPECT_EQ(spec.get_string_attribute("ImageDescription"), "a scene") << name;
  }
  EXPECT_EQ(read(file("a.exr")).spec.get_string_attribute("alhazen:samples"), "16");
  EXPECT_EQ(read(file("a.png")).spec.get_string_attribute("alhazen:samples"), "16");
}

TEST_F(ImageFile, AWriteThatFailsLeavesTheOldFileAndNothingElse) {
  const ColorImage image = random_image(200, 200, 1);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const char* name : {"a.exr", "a.png", "a.tif", "a.jpg", "a.sgi", "a.fits", "a.bmp"}) {
    std::ofstream(file(name)) << "old";
    rlimit small = before;
    small.rlim_cur = 4096;
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(write_image(file(name), image, {}, {}), WriteError) << name;
    setrlimit(RLIMIT_FSIZE, &before);
    std::string text;
    std::ifstream(file(name)) >> text;
    EXPECT_EQ(text, "old") << name;
    fs::remove(file(name));
    EXPECT_EQ(files(), 0u) << name;
  }
}

TEST_F(ImageFile, AnUnwritableDestinationIsFoundBeforehand) {
  fs::create_directory(file("folder.png"));
  for (const fs::path& path :
       {file("absent/a.png"), file("folder.png"), file("a.unheard"), file("a"), fs::path("/dev/a.png/b.png")})
    EXPECT_THROW(check_writable(path, 8, 8), WriteError) << path;
  EXPECT_THROW(check_writable(file("a.jpg"), 65536, 1), WriteError);
  EXPECT_THROW(check_writable(file("a.ico"), 300, 1), WriteError);
  EXPECT_NO_THROW(check_writable(file("a.png"), 65536, 65536));
  EXPECT_EQ(files(), 1u);  // the folder
}

TEST_F(ImageFile, WhatIsKnownOfFormatsIsWhatTheLibrarySays) {
  for (const char* extension :
       {".exr", ".png", ".hdr", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".tga", ".bmp", ".ppm"}) {
    const auto said = image_library().writer_format(extension);
    ASSERT_TRUE(said) << extension;
    const ImageFormat known = image_format(std::string("a") + extension);
    EXPECT_EQ(known.name, said->name) << extension;
    EXPECT_EQ(known.alpha, said->alpha) << extension;
  }
}

TEST_F(ImageFile, ALibraryThatIsBeingLoadedMayBeAskedAnywhere) {
  preload_image_library();
  preload_image_library();
  EXPECT_EQ(&image_library(), &image_library());
}

TEST_F(ImageFile, AFormatRefusesChoicesThatItLacks) {
  EXPECT_THROW(check_encoding("a.png", {.half = true}), UsageError);
  EXPECT_THROW(check_encoding("a.png", {.compression = "zip"}), UsageError);
  EXPECT_THROW(check_encoding("a.exr", {.compression = "lzw"}), UsageError);
  EXPECT_THROW(check_encoding("a.exr", {.quality = 5}), UsageError);
  EXPECT_NO_THROW(check_encoding("a.exr", {.half = true, .compression = "dwaa"}));
  EXPECT_NO_THROW(check_encoding("a.jpg", {.quality = 5}));
}

TEST_F(ImageFile, APartFileTakesItsTargetsPlaceOnlyWhenCommitted) {
  const std::vector<uint8_t> bytes{'n', 'e', 'w'};
  std::ofstream(file("a")) << "old";
  fs::create_symlink("a", file("link"));
  const auto content = [&] {
    std::string text;
    std::ifstream(file("a")) >> text;
    return text;
  };
  { PartFile(file("link")).write(bytes); }
  EXPECT_EQ(content(), "old");
  {
    PartFile part(file("link"));
    part.write(bytes);
    EXPECT_EQ(content(), "old");
    part.commit();
  }
  EXPECT_EQ(content(), "new");
  EXPECT_TRUE(fs::is_symlink(file("link")));
  EXPECT_EQ(files(), 2u);
}

}  // namespace
}  // namespace alhazen
