// Files may ask for no more than they are given, and are told so.
#include "loaders/load_limits.h"

#include <gtest/gtest.h>

#include "gltf_builder.h"
#include "loaders/gltf_file.h"
#include "loaders/image_decode.h"
#include "loaders/image_header.h"

namespace alhazen {
namespace {

std::string refusal(const json& document, const LoadLimits& limits) {
  const TemporaryFolder folder;
  try {
    LoadedScene loaded =
        load_gltf(folder.write("scene.gltf", document.dump()), {}, {}, std::make_shared<LoadBudget>(limits));
    (void)decode_images(loaded.encoded, {}, *loaded.budget);
  } catch (const LoadError& error) {
    const std::string what = error.what();
    return what.substr(what.find("scene.gltf"));
  }
  return "";
}

std::string big_endian(uint32_t v) { return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)}; }

/// A PNG's signature and header: 8 bits, RGB.
std::string png_head(uint32_t width, uint32_t height) {
  return "\x89PNG\r\n\x1a\n" + big_endian(13) + "IHDR" + big_endian(width) + big_endian(height) +
         std::string("\x08\x02\0\0\0", 5) + big_endian(0);
}

GltfBuilder textured(const std::string& image) {
  GltfBuilder b;
  b.root["images"] = {{{"uri", "data:image/png;base64," + base64(image)}}};
  b.root["textures"] = {{{"source", 0}}};
  b.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  return b;
}

json chain(int nodes) {
  json root = {{"asset", {{"version", "2.0"}}}};
  for (int i = 0; i + 1 < nodes; ++i) root["nodes"].push_back({{"children", {i + 1}}});
  root["nodes"].push_back(json::object());
  return root;
}

TEST(LoadLimits, MemoryIsCountedAndTheMessageSaysWhatRaisesIt) {
  GltfBuilder b;
  const int position = b.add("accessors", {{"type", "VEC3"}, {"count", 300000}, {"componentType", 5126}});
  b.mesh({{"attributes", {{"POSITION", position}}}});
  EXPECT_EQ(refusal(b.document(), {}), "");
  EXPECT_EQ(refusal(b.document(), {.memory = 4 << 20}),
            "scene.gltf: /meshes/0/primitives/0: needs 9.2 MiB of memory, 5.4 KiB of 4.0 MiB are taken; --max-memory "
            "raises the limit");
  EXPECT_EQ(refusal(b.document(), {.memory = 1 << 30}), "");
}

TEST(LoadLimits, AFileIsCountedOnceHoweverOftenItIsPosed) {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}},
          {"targets", {{{"POSITION", b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}}}}});
  b.root["meshes"][0]["weights"] = {0};
  const int instances = b.vec3({0, 0, 0, 1, 0, 0});
  b.add("nodes",
        {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", instances}}}}}}}});
  const int times = b.accessor(std::vector<float>{0, 1}, "SCALAR", 5126, 2);
  b.add("animations",
        {{"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
           {{"sampler", 1}, {"target", {{"node", 1}, {"path", "translation"}}}}}},
         {"samplers",
          {{{"input", times}, {"output", times}}, {{"input", times}, {"output", b.vec3({0, 0, 0, 1, 1, 1})}}}}});
  const TemporaryFolder folder;
  const auto budget = std::make_shared<LoadBudget>();
  GltfFile file(folder.write("scene.gltf", b.document().dump()), {}, {}, {"", 0.0}, budget);
  LoadedScene loaded = file.load(0);
  const uint64_t taken = budget->taken();
  for (int frame = 0; frame < 200; ++frame) file.move(loaded.scene, frame / 200.0);
  EXPECT_EQ(budget->taken(), taken);
  EXPECT_EQ(loaded.scene.geometry.mesh_instances.size(), 3u);
}

TEST(LoadLimits, WarningsEndAfterAThousand) {
  json document = {{"asset", {{"version", "2.0"}}}};
  for (int i = 0; i < 3000; ++i) document["nodes"].push_back({{"skin", 0}});
  document["skins"] = {{{"joints", {0}}}};
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  GltfFile file(folder.write("scene.gltf", document.dump()),
                [&](const std::string& text) { warnings.push_back(text); });
  file.examine();
  ASSERT_EQ(warnings.size(), 1001u);
  EXPECT_TRUE(warnings.back().ends_with("there are more warnings, which are left out"));
}

TEST(LoadLimits, ALargerFileMayUnfoldToMore) {
  GltfBuilder b;
  const int position = b.add("accessors", {{"type", "VEC3"}, {"count", 3000000}, {"componentType", 5126}});
  b.mesh({{"attributes", {{"POSITION", position}}}});
  EXPECT_NE(refusal(b.document(), {}), "");
  json larger = b.document();
  larger["extras"] = std::string(4 << 20, 'x');
  EXPECT_EQ(refusal(larger, {}), "");
}

TEST(LoadLimits, ImagesHaveAMostOfPixelsAndOfMemory) {
  EXPECT_EQ(refusal(textured(png_head(60000, 50000)).document(), {}),
            "scene.gltf: /images/0: its image has 60000 x 50000 pixels, expected 268435456 at most; "
            "--max-image-pixels raises the limit");
  EXPECT_TRUE(refusal(textured(png_head(16000, 16000)).document(), {})
                  .starts_with("scene.gltf: /images/0: needs 977 MiB of memory"));
  EXPECT_EQ(refusal(textured(png_head(100, 100)).document(), {.image_pixels = 9999}),
            "scene.gltf: /images/0: its image has 100 x 100 pixels, expected 9999 at most; --max-image-pixels raises "
            "the limit");
}

TEST(LoadLimits, NodesNestNoDeeperThanTheLimit) {
  EXPECT_EQ(refusal(chain(4096), {}), "");
  EXPECT_EQ(refusal(chain(4097), {}),
            "scene.gltf: /nodes/4096: is nested more than 4096 deep; --max-node-depth raises the limit");
  EXPECT_EQ(refusal(chain(4097), {.node_depth = 4097}), "");
}

TEST(LoadLimits, JsonIsNoLongerThanTheLimit) {
  EXPECT_EQ(refusal(chain(2), {.json = 10}),
            "scene.gltf: its JSON takes 57 bytes, expected at most 10 bytes; --max-json raises the limit");
}

TEST(LoadLimits, AFileThatIsReadAgainLetsThroughNoMore) {
  LoadBudget budget;
  const uint64_t any = uint64_t{190} << 20;
  budget.take_file("a.bin", 1 << 20);
  budget.take("there", any);
  for (int i = 0; i < 100; ++i) budget.take_file("a.bin", 1 << 20);
  EXPECT_THROW(budget.take("there", any), LoadError);
}

TEST(LoadLimits, CountsThatOverflowAreTooMuch) {
  const JsonDocument document{"scene.gltf", json::object()};
  LoadBudget budget;
  EXPECT_THROW(budget.take(JsonRef(document), uint64_t{1} << 62, 16), LoadError);
  EXPECT_THROW(budget.take("there", ~uint64_t{0}), LoadError);
  EXPECT_EQ(budget.taken(), 0u);
}

// ---- Image headers ----

std::optional<ImageHeader> header_of(const std::string& file) {
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(file.data()), file.size());
  const auto kind = image_kind(bytes);
  return kind ? read_image_header(*kind, bytes) : std::nullopt;
}

TEST(ImageHeader, IsReadFromEveryKind) {
  const auto size = [](const std::string& file) {
    const auto header = header_of(file);
    return header ? std::pair(header->width, header->height) : std::pair<uint64_t, uint64_t>(0, 0);
  };
  const std::pair<uint64_t, uint64_t> expected(300, 200);
  EXPECT_EQ(size(png_head(300, 200)), expected);
  const std::string frame("\x08\x00\xc8\x01\x2c\x03\x01\x11\0\x02\x11\0\x03\x11\0", 15);
  EXPECT_EQ(size(std::string("\xff\xd8\xff\xe0\0\x04..\xff\xff\xc0\0\x11", 13) + frame), expected);
  EXPECT_EQ(size(std::string("RIFF....WEBPVP8 ....\0\0\0\x9d\x01\x2a\x2c\x01\xc8\0", 30)), expected);
  EXPECT_EQ(size(std::string("RIFF....WEBPVP8X....\0\0\0\0\x2b\x01\0\xc7\0\0", 30)), expected);
  const uint32_t lossless = 299 | 199 << 14;
  EXPECT_EQ(size("RIFF....WEBPVP8L....\x2f" + raw_bytes(std::vector<uint32_t>{lossless})), expected);
  EXPECT_EQ(size("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 200 +X 300\n"), expected);
  EXPECT_EQ(size("BM............" + raw_bytes(std::vector<int32_t>{40, 300, -200, 0})), expected);
  EXPECT_EQ(size("DDS " + raw_bytes(std::vector<uint32_t>{124, 7, 200, 300})), expected);
  std::string ktx = "\xABKTX 20\xBB\r\n\x1A\n" + raw_bytes(std::vector<uint32_t>{37, 1, 300, 200, 0, 0, 1, 1, 0});
  ktx.resize(104);
  EXPECT_EQ(size(ktx), expected);
}

TEST(ImageHeader, OpenExrTellsItsWindowAndChannels) {
  const auto attribute = [](const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + raw_bytes(std::vector<uint32_t>{uint32_t(value.size())}) + value;
  };
  const std::string channel = std::string("R\0", 2) + std::string(16, '\1');
  const std::string window = raw_bytes(std::vector<int32_t>{-10, 5, 289, 204});
  const std::string head = std::string("\x76\x2f\x31\x01\x02\0\0\0", 8);
  const std::string file =
      head + attribute("channels", "chlist", channel + '\0') + attribute("dataWindow", "box2i", window);
  const auto header = header_of(file + '\0');
  ASSERT_TRUE(header);
  EXPECT_EQ(header->pixels(), 300u * 200u);
  EXPECT_FALSE(header_of(file));                                                    // cut off
  EXPECT_FALSE(header_of(head + attribute("dataWindow", "box2i", window) + '\0'));  // no channels
}

TEST(ImageHeader, CutOffAnywhereIsNone) {
  const std::string whole = png_head(300, 200);
  for (size_t n = 0; n < 29; ++n) EXPECT_FALSE(header_of(whole.substr(0, n)));
  EXPECT_TRUE(header_of(whole));
}

TEST(ImageHeader, CountsWhatADecoderTakesBesides) {
  std::string png = png_head(300, 200);
  EXPECT_EQ(header_of(png)->scratch, 0u);
  png[28] = 1;  // interlaced
  EXPECT_EQ(header_of(png)->scratch, 300u * 200u * 3u);
}

}  // namespace
}  // namespace alhazen
