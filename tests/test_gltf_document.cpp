// Containers, URIs and JSON: what stands between a file and its values.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "gltf_builder.h"
#include "loaders/gltf_uri.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

std::string word(size_t v) { return raw_bytes(std::vector<uint32_t>{uint32_t(v)}); }
std::string chunk(const char* type, const std::string& bytes) {
  return word(bytes.size()) + std::string(type, 4) + bytes;
}
std::string padded(std::string text, char with) {
  text.resize((text.size() + 3) / 4 * 4, with);
  return text;
}
std::string glb_of(const std::string& chunks, uint32_t version = 2) {
  return "glTF" + word(version) + word(12 + chunks.size()) + chunks;
}

/// One triangle whose buffer is the GLB's second chunk.
std::string triangle_glb() {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
  b.root["buffers"] = {{{"byteLength", b.bytes.size()}}};
  return glb_of(chunk("JSON", padded(b.root.dump(), ' ')) + chunk("BIN\0", padded(b.bytes, '\0')));
}

std::string error_of_bytes(const std::string& bytes) {
  const TemporaryFolder folder;
  return error_of_file(folder.write("scene.glb", bytes));
}

/// A triangle whose positions lie behind `uri`.
json triangle_behind(const std::string& uri) {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}});
  b.root["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
  return b.root;
}
const std::string kTriangleBytes = raw_bytes(kTriangle);

TEST(GltfGlb, HoldsItsBufferInTheSecondChunk) {
  const TemporaryFolder folder;
  const Loaded loaded = load_file(folder.write("scene.glb", triangle_glb()));
  EXPECT_EQ(loaded.part().positions[1], (Vec3f{1, 0, 0}));
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(GltfGlb, MayBeFollowedByMoreChunksAndGarbage) {
  std::string glb = triangle_glb() + chunk("ABCD", "more") + "garbage";
  EXPECT_EQ(error_of_bytes(glb), "");
  glb.replace(8, 4, word(glb.size() - 7));
  EXPECT_EQ(error_of_bytes(glb), "");
}

TEST(GltfGlb, SaysWhatIsWrongWithItsHeaderAndChunks) {
  const std::string json_text = R"({"asset":{"version":"2.0"}}  )";
  EXPECT_EQ(error_of_bytes("glTF"), "expected a GLB header, found only 4 bytes");
  EXPECT_EQ(error_of_bytes(glb_of(chunk("JSON", json_text), 1)), "expected GLB version 2, found 1");
  EXPECT_EQ(error_of_bytes(glb_of(chunk("BIN\0", json_text))), "expected JSON as the GLB's first chunk");
  std::string glb = glb_of(chunk("JSON", json_text));
  glb.replace(12, 4, word(4000000000u));
  EXPECT_EQ(error_of_bytes(glb), "GLB chunk 0 of 4000000000 bytes exceeds the file");
  glb = glb_of(chunk("JSON", json_text));
  glb.replace(8, 4, word(4000000000u));
  EXPECT_TRUE(error_of_bytes(glb).starts_with("expected a GLB of 4000000000 bytes, found"));
}

TEST(GltfGlb, CutShortAnywhereIsAnError) {
  const std::string glb = triangle_glb();
  for (size_t length = 0; length < glb.size(); ++length)
    ASSERT_NE(error_of_bytes(glb.substr(0, length)), "") << length << " bytes";
}

TEST(GltfGlb, WithAnyByteChangedEndsInASceneOrALoadError) {
  const std::string glb = triangle_glb();
  for (size_t i = 0; i < glb.size(); ++i)
    for (const char c : {'\0', '\x7f', '\xff', '"', '9'}) {
      std::string changed = glb;
      changed[i] = c;
      (void)error_of_bytes(changed);
    }
}

TEST(GltfJson, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(error_of_bytes("\xEF\xBB\xBF{\"asset\":{\"version\":\"2.0\"}}"), "");
}

TEST(GltfJson, IsLimitedInDepth) {
  const auto nested = [](size_t n) {
    return R"({"asset":{"version":"2.0"},"extras":)" + std::string(n, '[') + std::string(n, ']') + "}";
  };
  EXPECT_EQ(error_of_bytes(nested(63)), "");
  EXPECT_EQ(error_of_bytes(nested(64)), "its JSON is nested more than 64 deep");
  EXPECT_EQ(error_of_bytes(nested(1000000)), "its JSON is nested more than 64 deep");
  EXPECT_EQ(error_of_bytes(R"({"asset":{"version":"2.0"},"extras":")" + std::string(100, '[') + "\"}"), "");
}

TEST(GltfJson, ThatIsNotValidIsAnError) {
  for (const char* text : {"", "{", "[1,", "{\"asset\":{\"version\":\"2.0\"},\"x\":NaN}", "{\"asset\":\"\xff\"}", "\0"})
    EXPECT_TRUE(error_of_bytes(text).starts_with("not valid JSON: ")) << text;
  EXPECT_EQ(error_of_bytes("[]"), "expected an object, found []");
  EXPECT_EQ(error_of_bytes("{}"), "`asset` is missing");
}

TEST(GltfJson, TakesIntegersWrittenWithAFraction) {
  GltfBuilder b;
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}, {"mode", 4.0}});
  EXPECT_EQ(load(b).part().triangles.size(), 1u);
}

TEST(GltfFile, ThatIsMissingOrNoRegularFileIsAnError) {
  const TemporaryFolder folder;
  const std::string expected = "cannot be read, expected a .gltf or .glb file";
  EXPECT_EQ(error_of_file(folder / "absent.gltf"), expected);
  fs::create_directory(folder / "folder.gltf");
  EXPECT_EQ(error_of_file(folder / "folder.gltf"), expected);
  ASSERT_EQ(::mkfifo((folder / "pipe.gltf").c_str(), 0600), 0);
  EXPECT_EQ(error_of_file(folder / "pipe.gltf"), expected);
}

TEST(GltfUri, OfDataMayHaveAnyMediaType) {
  for (const char* head : {"data:application/octet-stream;base64,", "data:;base64,", "data:model/gltf;name=a;base64,"})
    EXPECT_EQ(error_of(triangle_behind(head + base64(kTriangleBytes))), "") << head;
  std::string escaped;
  for (const char c : kTriangleBytes) {
    constexpr const char* kHex = "0123456789abcdef";
    escaped += {'%', kHex[uint8_t(c) >> 4], kHex[uint8_t(c) & 15]};
  }
  EXPECT_EQ(error_of(triangle_behind("data:," + escaped)), "");
  EXPECT_EQ(error_of(triangle_behind("data:nothing")), "/buffers/0/uri: expected a comma in the data URI");
  EXPECT_EQ(error_of(triangle_behind("data:;base64,*")), "/buffers/0/uri: expected base64 in the data URI");
  EXPECT_EQ(error_of(triangle_behind("data:;base64,AAAA")),
            "/buffers/0/byteLength: expected 36 bytes, the buffer has 3 bytes");
}

TEST(GltfUri, IsPercentDecodedOnce) {
  const TemporaryFolder folder;
  for (const auto& [uri, name] : {std::pair{"a%20b.bin", "a b.bin"},
                                  {"a b.bin", "a b.bin"},
                                  {"%C3%A4.bin", "ä.bin"},
                                  {"100%25.bin", "100%.bin"},
                                  {"%2541.bin", "%41.bin"},
                                  {"50%.bin", "50%.bin"},
                                  {"sub/./../sub/x.bin", "sub/x.bin"},
                                  {"..x.bin", "..x.bin"}}) {
    folder.write(name, kTriangleBytes);
    EXPECT_EQ(error_of_file(folder.write("scene.gltf", triangle_behind(uri).dump())), "") << uri;
  }
}

TEST(GltfUri, MayNameAFileLongerThanItsBuffer) {
  const TemporaryFolder folder;
  folder.write("long.bin", kTriangleBytes + "and more");
  EXPECT_EQ(error_of_file(folder.write("scene.gltf", triangle_behind("long.bin").dump())), "");
}

TEST(GltfUri, CannotLeaveTheFolderOfTheScene) {
  const TemporaryFolder folder;
  folder.write("secret.bin", kTriangleBytes);
  folder.write("scene/inside.bin", kTriangleBytes);
  fs::create_symlink(folder / "secret.bin", folder / "scene/out.bin");
  fs::create_directory_symlink(folder / "", folder / "scene/up");
  fs::create_symlink("inside.bin", folder / "scene/in.bin");
  const auto error = [&](const std::string& uri) {
    return error_of_file(folder.write("scene/scene.gltf", triangle_behind(uri).dump()));
  };
  EXPECT_EQ(error("inside.bin"), "");
  EXPECT_EQ(error("in.bin"), "");
  EXPECT_EQ(error("../secret.bin"), "/buffers/0/uri: `../secret.bin` lies outside the scene's folder");
  for (const char* uri :
       {"%2e%2e/secret.bin", "..%2fsecret.bin", "%2e%2e%2fsecret.bin", "./../secret.bin", "a/../../secret.bin",
        "../scene/../secret.bin", "out.bin", "up/secret.bin", "../absent.bin", "../../../../../../../../etc/passwd"})
    EXPECT_NE(error(uri).find("lies outside the scene's folder"), std::string::npos) << uri << ": " << error(uri);
  for (const std::string& uri :
       {(folder / "secret.bin").string(), std::string("/etc/passwd"), std::string("//etc/passwd"),
        std::string("%2fetc/passwd"), (folder / "scene/inside.bin").string()})
    EXPECT_NE(error(uri).find("expected a path relative to the scene's folder"), std::string::npos) << uri;
  for (const char* uri : {"file:///etc/passwd", "FILE:/etc/passwd", "http://example.org/a.bin", "c:/a.bin",
                          "absent.bin", "..\\secret.bin", "%252e%252e%252fsecret.bin", "inside.bin/", "inside.bin/x"})
    EXPECT_NE(error(uri).find("cannot read"), std::string::npos) << uri << ": " << error(uri);
  for (const char* uri : {"", "inside.bin%00"})
    EXPECT_NE(error(uri).find("expected the name of a file"), std::string::npos) << uri;
}

TEST(GltfUri, OfAFolderOrAPipeIsNotRead) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "folder");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const char* uri : {".", "folder", "pipe"})
    EXPECT_NE(error_of_file(folder.write("scene.gltf", triangle_behind(uri).dump())).find("cannot read"),
              std::string::npos)
        << uri;
}

TEST(Base64, DecodesWhatEncodingMakes) {
  std::string bytes;
  for (int i = 0; i < 300; ++i) {
    const auto decoded = decode_base64(base64(bytes));
    ASSERT_TRUE(decoded);
    ASSERT_EQ(std::string(decoded->begin(), decoded->end()), bytes);
    bytes += char(i * 37);
  }
  EXPECT_EQ(*decode_base64("_-\n8="), (Bytes{0xff, 0xef}));
}

}  // namespace
}  // namespace alhazen
