// Claims about Cryptomatte: a decoder that knows files alone finds every object's coverage again.
#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "inspect/matte_picture.h"
#include "loaders/layer_file.h"
#include "renderer/cryptomatte.h"
#include "tests/loaded_subject.h"
#include "tests/moving_scene.h"

namespace alhazen {
namespace {

/// What the specification has a compositor do: names from the manifest, coverages by the bits of their ids.
struct Decoded {
  std::map<std::string, std::vector<float>> coverage;  // by name
  int width = 0, height = 0;
};

Decoded decode(const std::filesystem::path& file, const std::string& layer) {
  const auto in = OIIO::ImageInput::open(file.string());
  const OIIO::ImageSpec spec = in->spec();
  std::string key;
  for (const auto& attribute : spec.extra_attribs) {
    const std::string name = attribute.name().string();
    if (name.starts_with("cryptomatte/") && name.ends_with("/name") && attribute.get_string() == layer)
      key = name.substr(0, name.size() - 4);
  }
  EXPECT_EQ(key.size(), 12u + 7 + 1) << layer;
  EXPECT_EQ(spec.get_string_attribute(key + "hash"), "MurmurHash3_32");
  EXPECT_EQ(spec.get_string_attribute(key + "conversion"), "uint32_to_float32");
  std::map<uint32_t, std::string> names;
  const auto manifest = nlohmann::json::parse(spec.get_string_attribute(key + "manifest"));
  for (const auto& [name, id] : manifest.items())
    names[uint32_t(std::stoul(id.get<std::string>(), nullptr, 16))] = name;

  Decoded decoded{{}, spec.width, spec.height};
  const size_t pixels = size_t(spec.width) * size_t(spec.height);
  std::vector<float> all(pixels * size_t(spec.nchannels));
  EXPECT_TRUE(in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, all.data()));
  for (int image = 0;; ++image) {
    const std::string prefix = layer + "0" + std::to_string(image) + ".";
    if (spec.channelindex(prefix + "R") < 0) return decoded;
    for (const auto& [id_channel, coverage_channel] : {std::pair{"R", "G"}, std::pair{"B", "A"}})
      for (size_t i = 0; i < pixels; ++i) {
        const auto value = [&](const char* channel) {
          return all[i * size_t(spec.nchannels) + size_t(spec.channelindex(prefix + channel))];
        };
        if (!(value(coverage_channel) > 0)) continue;
        const auto name = names.find(std::bit_cast<uint32_t>(value(id_channel)));
        if (name == names.end()) {
          ADD_FAILURE() << "an id that the manifest does not know";
          continue;
        }
        std::vector<float>& coverage = decoded.coverage[name->second];
        coverage.resize(pixels);
        coverage[i] += value(coverage_channel);
      }
  }
}

Decoded through_a_file(const RenderResult& result, const std::string& layer, const ImageEncoding& encoding) {
  const auto file = std::filesystem::temp_directory_path() / ("alhazen-crypto-" + std::to_string(getpid()) + ".exr");
  write_layers(file, result.color, result.layers, false, encoding, {});
  const Decoded decoded = decode(file, layer);
  std::filesystem::remove(file);
  return decoded;
}

Decoded through_a_file(const Subject& subject, RenderOptions options, const std::string& layer,
                       const ImageEncoding& encoding) {
  options.layers = {Layer::crypto_node, Layer::crypto_mesh, Layer::crypto_material, Layer::albedo};
  return through_a_file(subject.result(options), layer, encoding);
}

TEST(Cryptomatte, HashesAreMurmurs) {
  EXPECT_EQ(name_hash(""), 0u);
  EXPECT_EQ(name_hash("hello"), 0x248bfa47u);
  EXPECT_EQ(name_hash("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(name_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(Cryptomatte, IdsAreNumbersThatSurviveArithmetic) {
  for (int i = 0; i < 100000; ++i) {
    const float id = name_id("object " + std::to_string(i));
    ASSERT_TRUE(std::isnormal(id)) << i;
  }
}

TEST(Cryptomatte, EachObjectsMatteIsItsShareOfTheSignature) {
  const Subject subject(ALHAZEN_SHOWCASE, 1.5);
  const RenderOptions options{.width = 90, .height = 60};
  const Decoded decoded = through_a_file(subject, options, "CryptoNode", {});
  RenderOptions signature = options;
  signature.integrator = Integrator::signature;
  const IdImage ids = subject.result(signature).ids;
  EXPECT_EQ(decoded.coverage.size(), 5u);
  for (const auto& [name, coverage] : decoded.coverage)
    for (size_t i = 0; i < coverage.size(); ++i) {
      const uint32_t node = ids.pixels[3 * i];
      ASSERT_EQ(coverage[i], node != kNone && subject.scene.node_names[node] == name ? 1.0f : 0.0f) << name << " " << i;
    }
}

TEST(Cryptomatte, ItsPictureTellsApartWhatTheSignatureTellsApart) {
  const Subject subject(ALHAZEN_SHOWCASE, 1.5);
  RenderOptions options{.width = 90, .height = 60, .layers = {Layer::crypto_node}};
  const std::vector<LayerImage> layers = subject.result(options).layers;
  const ColorImage picture = matte_picture(layers, 90, 60);
  options.layers.clear(), options.integrator = Integrator::signature;
  const IdImage ids = subject.result(options).ids;
  std::map<uint32_t, std::array<float, 3>> color_of_node;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 90; ++x) {
      const float* c = picture.at(x, y);
      const auto [color, fresh] =
          color_of_node.try_emplace(ids.pixels[3 * (size_t(y) * 90 + size_t(x))], std::array{c[0], c[1], c[2]});
      EXPECT_EQ(color->second, (std::array{c[0], c[1], c[2]})) << x << " " << y;
    }
  std::set<std::array<float, 3>> colors;
  for (const auto& [node, color] : color_of_node) colors.insert(color);
  EXPECT_EQ(colors.size(), color_of_node.size());
  EXPECT_EQ(colors.size(), 6u);  // five nodes and the background
}

TEST(Cryptomatte, MattesAddUpToAlpha) {
  for (const std::filesystem::path& file : small_scenes()) {
    SCOPED_TRACE(file.filename().string());
    const Subject subject(file, 1.5);
    const RenderOptions options{.width = 60, .height = 40, .samples = 4, .transparent = true};
    const ColorImage picture = subject.picture(options);
    for (const char* layer : {"CryptoNode", "CryptoMesh", "CryptoMaterial"}) {
      std::vector<float> sum(60 * 40);
      for (const auto& [name, coverage] : through_a_file(subject, options, layer, {}).coverage)
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += coverage[i];
      for (size_t i = 0; i < sum.size(); ++i)
        ASSERT_NEAR(sum[i], picture.pixels[4 * i + 3], 1e-5f) << layer << " " << i;
    }
  }
}

TEST(Cryptomatte, AMovingObjectsMatteIsItsShareOfTheTime) {
  MovingScene scene(2);
  const int wall = scene.rectangle(60, 20), bar = scene.rectangle(6, 20);
  scene.root["nodes"][size_t(wall)]["name"] = "wall", scene.root["nodes"][size_t(bar)]["name"] = "bar";
  scene.move(bar, {-10, 0, 1, 10, 0, 1});
  MovingSubject subject(scene);
  subject.open_shutter(0, 1);
  RenderOptions options{.width = 40, .height = 4, .samples = 256};
  options.layers = {Layer::crypto_node};
  Decoded decoded = through_a_file(subject.result(options), "CryptoNode", {});
  ASSERT_EQ(decoded.coverage.size(), 2u);
  for (size_t i = 0; i < 160; ++i) {
    const double expected = trapezoid(double(i % 40) + 0.5 - 20, 6);
    EXPECT_NEAR(double(decoded.coverage["bar"][i]), expected, 0.02) << i;
    EXPECT_NEAR(double(decoded.coverage["wall"][i]), 1 - expected, 0.02) << i;
  }
}

TEST(Cryptomatte, HalvesAndLossyCompressionDoNotReachIds) {
  const Subject subject(ALHAZEN_SHOWCASE, 1.5);
  const RenderOptions options{.width = 90, .height = 60, .samples = 2};
  const Decoded exact = through_a_file(subject, options, "CryptoMaterial", {});
  const Decoded asked = through_a_file(subject, options, "CryptoMaterial", {.half = true, .compression = "dwaa"});
  EXPECT_EQ(exact.coverage, asked.coverage);
  EXPECT_EQ(exact.coverage.size(), 5u);
}

TEST(Cryptomatte, ManifestsHoldAnyName) {
  const std::vector<std::string> names{"a\"b\\c", "tab\there", "Größe", "a\"b\\c"};
  std::string manifest;
  for (const auto& [key, value] : cryptomatte_metadata("CryptoNode", names))
    if (key.ends_with("manifest")) manifest = value;
  const auto json = nlohmann::json::parse(manifest);
  EXPECT_EQ(json.size(), 3u);
  for (const std::string& name : names) EXPECT_TRUE(json.contains(name)) << name;
}

}  // namespace
}  // namespace alhazen
