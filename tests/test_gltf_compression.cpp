// Compressed and quantized vertices: what an encoder put in comes out, and a stream that lies is refused at its place.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <numeric>
#include <random>

#include "gltf_builder.h"
#include "loaders/gltf_buffer_views.h"
#include "loaders/gltf_uri.h"

namespace alhazen {
namespace {

/// A bumpy grid of n x n vertices.
struct Grid {
  std::vector<float> positions, normals, uvs;
  std::vector<uint32_t> index;
  uint32_t n;

  explicit Grid(uint32_t side, uint32_t seed = 1) : n(side) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<float> height(-0.2f, 0.2f);
    for (uint32_t y = 0; y < n; ++y)
      for (uint32_t x = 0; x < n; ++x) {
        const float h = height(rng), length = std::sqrt(1 + h * h);
        positions.insert(positions.end(), {float(x), float(y), h});
        normals.insert(normals.end(), {h / length, 0, 1 / length});
        uvs.insert(uvs.end(), {float(x) / float(n), float(y) / float(n)});
      }
    for (uint32_t y = 0; y + 1 < n; ++y)
      for (uint32_t x = 0; x + 1 < n; ++x) {
        const uint32_t a = y * n + x, b = a + 1, c = a + n, d = c + 1;
        index.insert(index.end(), {a, b, c, b, d, c});
      }
  }
  [[nodiscard]] uint32_t vertices() const { return n * n; }
  [[nodiscard]] Vec3f position(uint32_t i) const {
    return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
  }
};

// ---- meshoptimizer ----

std::string encode_vertices(const void* data, size_t count, size_t stride) {
  std::string out(meshopt_encodeVertexBufferBound(count, stride), '\0');
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), data, count, stride));
  return out;
}
std::string encode_triangles(const std::vector<uint32_t>& index, size_t vertices) {
  std::string out(meshopt_encodeIndexBufferBound(index.size(), vertices), '\0');
  out.resize(
      meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), index.data(), index.size()));
  return out;
}
std::string encode_indices(const std::vector<uint32_t>& index, size_t vertices) {
  std::string out(meshopt_encodeIndexSequenceBound(index.size(), vertices), '\0');
  out.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(out.data()), out.size(), index.data(),
                                         index.size()));
  return out;
}

/// A buffer view of a stream in buffer 0 that stands in for one of the placeholder, buffer 1.
json compressed_view(GltfBuilder& b, const std::string& stream, const char* mode, size_t count, size_t stride,
                     const char* filter = nullptr, const char* extension = "EXT_meshopt_compression") {
  const int plain = b.view(stream);
  json e = {{"buffer", 0},    {"byteOffset", b.root["bufferViews"][size_t(plain)]["byteOffset"]},
            {"mode", mode},   {"byteLength", stream.size()},
            {"count", count}, {"byteStride", stride}};
  if (filter) e["filter"] = filter;
  b.root["bufferViews"].erase(size_t(plain));
  return {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{extension, e}}}};
}

json with_placeholder(const GltfBuilder& b) {
  json document = b.document();
  document["buffers"].push_back(
      {{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  return document;
}

/// The decoded bytes of buffer view 0.
Bytes decoded(const json& document) {
  const TemporaryFolder folder;
  const GltfSource source = read_gltf_source(folder.write("scene.gltf", document.dump()), {});
  const GltfBufferViews views(source);
  return {views[0].begin(), views[0].end()};
}

template <class T>
std::vector<T> values_in(const Bytes& bytes) {
  std::vector<T> all(bytes.size() / sizeof(T));
  std::memcpy(all.data(), bytes.data(), bytes.size());
  return all;
}

json view_alone(const std::string& stream, const char* mode, size_t count, size_t stride, const char* filter = nullptr,
                const char* extension = "EXT_meshopt_compression") {
  GltfBuilder b;
  b.add("bufferViews", compressed_view(b, stream, mode, count, stride, filter, extension));
  return with_placeholder(b);
}

TEST(Meshopt, EveryModeGivesBackItsBytes) {
  for (const uint32_t side : {2u, 17u, 70u}) {
    const Grid grid(side);
    for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      const Bytes bytes = decoded(view_alone(encode_vertices(grid.positions.data(), grid.vertices(), 12), "ATTRIBUTES",
                                             grid.vertices(), 12, nullptr, extension));
      EXPECT_EQ(values_in<float>(bytes), grid.positions);
    }
    const auto indices = [&](const std::string& stream, const char* mode, size_t stride) {
      const Bytes bytes = decoded(view_alone(stream, mode, grid.index.size(), stride));
      if (stride == 4) return values_in<uint32_t>(bytes);
      const auto narrow = values_in<uint16_t>(bytes);
      return std::vector<uint32_t>(narrow.begin(), narrow.end());
    };
    for (const size_t stride : {2u, 4u}) {
      EXPECT_EQ(indices(encode_indices(grid.index, grid.vertices()), "INDICES", stride), grid.index);
      // The codec of triangles may turn them.
      auto found = indices(encode_triangles(grid.index, grid.vertices()), "TRIANGLES", stride);
      ASSERT_EQ(found.size(), grid.index.size());
      for (size_t i = 0; i < found.size(); i += 3) {
        const auto first = grid.index.begin() + ptrdiff_t(i);
        const auto at = found.begin() + ptrdiff_t(i);
        std::rotate(at, std::find(at, at + 3, *first), at + 3);
        EXPECT_TRUE(std::equal(at, at + 3, first));
      }
    }
  }
}

std::vector<float> random_unit_vectors(size_t count, size_t components) {
  std::mt19937 rng(7);
  std::normal_distribution<float> normal;
  std::vector<float> all;
  for (size_t i = 0; i < count; ++i) {
    std::vector<float> v(components);
    for (float& x : v) x = normal(rng);
    const float length = std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0f));
    for (const float x : v) all.push_back(x / length);
    if (components == 3) all.push_back(0);
  }
  return all;
}

TEST(Meshopt, FiltersAreUndoneToTheirPrecision) {
  constexpr size_t kCount = 300;
  const std::vector<float> normals = random_unit_vectors(kCount, 3), rotations = random_unit_vectors(kCount, 4);
  std::vector<int8_t> oct8(4 * kCount);
  meshopt_encodeFilterOct(oct8.data(), kCount, 4, 8, normals.data());
  const auto bytes = values_in<int8_t>(
      decoded(view_alone(encode_vertices(oct8.data(), kCount, 4), "ATTRIBUTES", kCount, 4, "OCTAHEDRAL")));
  std::vector<int16_t> oct16(4 * kCount);
  meshopt_encodeFilterOct(oct16.data(), kCount, 8, 16, normals.data());
  const auto words = values_in<int16_t>(
      decoded(view_alone(encode_vertices(oct16.data(), kCount, 8), "ATTRIBUTES", kCount, 8, "OCTAHEDRAL")));
  for (size_t i = 0; i < normals.size(); ++i) {
    if (i % 4 == 3) continue;
    EXPECT_NEAR(bytes[i] / 127.0f, normals[i], 0.02);
    EXPECT_NEAR(words[i] / 32767.0f, normals[i], 1e-4);
  }

  std::vector<int16_t> quat(4 * kCount);
  meshopt_encodeFilterQuat(quat.data(), kCount, 8, 16, rotations.data());
  const auto turned = values_in<int16_t>(
      decoded(view_alone(encode_vertices(quat.data(), kCount, 8), "ATTRIBUTES", kCount, 8, "QUATERNION")));
  for (size_t i = 0; i < rotations.size(); i += 4) {
    float product = 0;  // q and -q are one rotation
    for (size_t k = 0; k < 4; ++k) product += rotations[i + k] * float(turned[i + k]) / 32767;
    EXPECT_NEAR(std::abs(product), 1, 1e-3);
  }

  const Grid grid(20);
  std::vector<uint32_t> exponential(grid.positions.size());
  meshopt_encodeFilterExp(exponential.data(), grid.vertices(), 12, 24, grid.positions.data());
  const auto floats = values_in<float>(decoded(view_alone(encode_vertices(exponential.data(), grid.vertices(), 12),
                                                          "ATTRIBUTES", grid.vertices(), 12, "EXPONENTIAL")));
  for (size_t i = 0; i < floats.size(); ++i) EXPECT_NEAR(floats[i], grid.positions[i], 1e-5);
}

/// Appendix B of KHR_meshopt_compression the other way round: `bits` for each of Y, Co, Cg.
template <class T>
void encode_color(const float* rgba, int bits, T* out) {
  const float most = float((1 << bits) - 1);
  const auto quantized = [&](float v, float scale) { return int(std::lround(v * scale)); };
  const int r = quantized(rgba[0], most), g = quantized(rgba[1], most), b = quantized(rgba[2], most);
  const int co = (r - b) / 2, t = b + co, cg = (g - t) / 2;
  out[0] = T(t + cg), out[1] = T(co), out[2] = T(cg);
  out[3] = T(quantized(rgba[3], float((1 << (bits - 1)) - 1)) | 1 << (bits - 1));
}

TEST(Meshopt, TheColorFilterIsUndoneToItsPrecision) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> share(0, 1);
  for (const int bits : {6, 8, 12, 16}) {
    constexpr size_t kCount = 200;
    std::vector<float> rgba(4 * kCount);
    for (float& v : rgba) v = share(rng);
    std::vector<uint8_t> narrow(4 * kCount);
    std::vector<uint16_t> wide(4 * kCount);
    for (size_t i = 0; i < kCount; ++i) {
      encode_color(&rgba[4 * i], bits, &wide[4 * i]);
      if (bits <= 8) encode_color(&rgba[4 * i], bits, &narrow[4 * i]);
    }
    const auto colors = values_in<uint16_t>(decoded(view_alone(encode_vertices(wide.data(), kCount, 8), "ATTRIBUTES",
                                                               kCount, 8, "COLOR", "KHR_meshopt_compression")));
    for (size_t i = 0; i < rgba.size(); ++i) EXPECT_NEAR(colors[i] / 65535.0f, rgba[i], 4.0 / (1 << bits));
    if (bits > 8) continue;
    const auto bytes = values_in<uint8_t>(decoded(view_alone(encode_vertices(narrow.data(), kCount, 4), "ATTRIBUTES",
                                                             kCount, 4, "COLOR", "KHR_meshopt_compression")));
    for (size_t i = 0; i < rgba.size(); ++i) EXPECT_NEAR(bytes[i] / 255.0f, rgba[i], 4.0 / (1 << bits));
  }
}

TEST(Meshopt, ACompressedMeshIsTheMesh) {
  const Grid grid(30);
  GltfBuilder b;
  b.add("bufferViews", compressed_view(b, encode_vertices(grid.positions.data(), grid.vertices(), 12), "ATTRIBUTES",
                                       grid.vertices(), 12));
  b.add("bufferViews",
        compressed_view(b, encode_indices(grid.index, grid.vertices()), "INDICES", grid.index.size(), 2));
  b.add("accessors", {{"bufferView", 0}, {"type", "VEC3"}, {"componentType", 5126}, {"count", grid.vertices()}});
  b.add("accessors", {{"bufferView", 1}, {"type", "SCALAR"}, {"componentType", 5123}, {"count", grid.index.size()}});
  b.mesh({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
  const Loaded loaded = load_json(with_placeholder(b));
  ASSERT_EQ(loaded.part().positions.size(), grid.vertices());
  ASSERT_EQ(loaded.part().triangles.size(), grid.index.size() / 3);
  for (uint32_t i = 0; i < grid.vertices(); ++i) EXPECT_EQ(loaded.part().positions[i], grid.position(i));
  for (size_t i = 0; i < grid.index.size(); ++i) EXPECT_EQ(loaded.part().triangles[i / 3][i % 3], grid.index[i]);
}

TEST(Meshopt, FaultsAreNamedAtTheirPlace) {
  const Grid grid(4);
  const std::string stream = encode_vertices(grid.positions.data(), 16, 12);
  const json valid = view_alone(stream, "ATTRIBUTES", 16, 12);
  const std::string at = "/bufferViews/0/extensions/EXT_meshopt_compression";
  const auto error = [&](const json& patch) {
    json document = valid;
    document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"].update(patch);
    return error_of(document);
  };
  EXPECT_EQ(error(json::object()), "");
  EXPECT_EQ(error({{"count", 4000000000u}}), at + "/count: 4000000000 elements are more than a stream of " +
                                                 std::to_string(stream.size()) + " bytes can hold");
  EXPECT_EQ(error({{"count", 300}}), at + ": its bytes are no stream of 300 ATTRIBUTES elements of 12 bytes");
  EXPECT_EQ(error({{"byteLength", stream.size() - 1}}),
            at + ": its bytes are no stream of 16 ATTRIBUTES elements of 12 bytes");
  EXPECT_TRUE(error({{"byteLength", stream.size() + 100}}).starts_with(at + ": "));
  EXPECT_TRUE(error({{"byteOffset", 4}}).starts_with(at + ": "));
  EXPECT_TRUE(error({{"byteStride", 10}}).starts_with(at + "/byteStride: expected a multiple of 4"));
  EXPECT_TRUE(error({{"byteStride", 260}}).starts_with(at + "/byteStride: expected an integer from 1 to 256"));
  EXPECT_TRUE(error({{"filter", "OCTAHEDRAL"}}).starts_with(at + "/byteStride: expected one of 4, 8"));
  EXPECT_TRUE(error({{"filter", "QUATERNION"}}).starts_with(at + "/byteStride: expected one of 8"));
  EXPECT_TRUE(error({{"filter", "COLOR"}}).starts_with(at + "/filter: expected one of NONE"));
  EXPECT_TRUE(error({{"mode", "POINTS"}}).starts_with(at + "/mode: expected one of"));
  EXPECT_TRUE(error({{"mode", "INDICES"}}).starts_with(at + "/byteStride: expected one of 2, 4"));
  EXPECT_TRUE(error({{"mode", "TRIANGLES"}, {"byteStride", 4}}).starts_with(at + "/count: expected a multiple of 3"));
  EXPECT_TRUE(error({{"mode", "INDICES"}, {"byteStride", 4}, {"filter", "EXPONENTIAL"}}).starts_with(at + "/filter: "));
  EXPECT_TRUE(error({{"buffer", 7}}).starts_with(at + "/buffer: index 7 out of range"));
  json plain = valid;
  plain["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 4}});
  EXPECT_EQ(error_of(plain), "/buffers/1: `uri` is missing, and the file has no GLB chunk for this buffer");
}

TEST(Meshopt, ViewsThatShareAStreamCannotUnfoldToTooMuch) {
  const std::vector<uint8_t> zeros(size_t{1} << 20, 0);
  GltfBuilder b;
  const json view =
      compressed_view(b, encode_vertices(zeros.data(), zeros.size() / 4, 4), "ATTRIBUTES", zeros.size() / 4, 4);
  for (int i = 0; i < 1000; ++i) b.add("bufferViews", view);
  EXPECT_TRUE(error_of(with_placeholder(b)).ends_with("--max-memory raises the limit"));
}

TEST(Meshopt, AnyByteOfAStreamChangedEndsInASceneOrAnErrorAtItsView) {
  const Grid grid(12);
  const std::string streams[] = {encode_vertices(grid.positions.data(), grid.vertices(), 12),
                                 encode_triangles(grid.index, grid.vertices()),
                                 encode_indices(grid.index, grid.vertices())};
  const char* const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
  std::mt19937 rng(5);
  for (int round = 0; round < 600; ++round) {
    const auto which = size_t(round % 3);
    std::string stream = streams[which];
    for (uint32_t k = 0; k <= rng() % 3; ++k) stream[rng() % stream.size()] = char(rng());
    if (rng() % 4 == 0) stream.resize(rng() % stream.size() + 1);
    const std::string error =
        error_of(view_alone(stream, modes[which], which ? grid.index.size() : grid.vertices(), which ? 4 : 12));
    ASSERT_TRUE(error.empty() || error.starts_with("/bufferViews/0/extensions/EXT_meshopt_compression")) << error;
  }
}

// Streams of version 1 that meshoptimizer 0.25 wrote; version 0.18 writes none.

/// 17 elements of three floats; its channels are coded by XOR with a rotation, by 16 bits and by 8.
const char* const kFloats =
    "oWhKegECAQMHAg/0wmLxMXEx6Bj+AQAPAWKx/4CA/4CA/wCcToJ+Af+CfgH/AQCCAAAA3+CQkGh4EO+oOLe49/gBOIDwBnx/gAEA"
    "fwAAAAAAAAAAAAAAAAAAAIC/AAAAAEIBAA==";
/// 300 elements of four bytes, in two blocks.
const char* const kBytes =
    "oZcA1oFwyDGpqhj6NxTquuV0d8k2AyfZDM1RzPbCw8AQk5nYoCUm7ZWG7F4iY/5xvsolONTDcXf3n9XXZNb7KEtMyTPqoRV+gHZB"
    "oNiqKoVtWycM/InzEZWAAkSOq72G6o4Wk9++0i+lOLN5pPfXQFbCRmyTbO0cFVT4Hy4AtGFwB75/AUdfzLJxWshMcL5lMRsh4egj"
    "WiuznMpDCpYc0/dCBz9GEOvRszpdLIqkVbO4yJkhLHVX1EzlOmng1jzyjc9+D7Z9EboZCRWPJJuq6S/NZW4Dz0HYTXcIz5GEMbBu"
    "gu0vEi/s1buIEVIpboC4IdzDjuuUqVk4VfZIdqNnJLoHqqqqqgIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIj"
    "IjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIjIj"
    "IjIjIjIjIjIjIjIjIjIjVVVVVSqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqq"
    "qqqqqqqqqqqXdN/rutBEJFNwkmR7ERFjc/MBMonL+qC/QaS231bt56+dYYQBXD272zINimYqIjIjIjIjIjIjIjIjIjIjIjIjIjIj"
    "IgAAFaqqqqqqqqqqqqqqAAAAAAAAAAAAAAAAAAAAAAAAAAB3AAD/AA==";

std::string bytes_of(const char* text) {
  const Bytes bytes = decode_base64(text).value();
  return {bytes.begin(), bytes.end()};
}

TEST(Meshopt, VersionOneOfTheVertexCodecGivesBackItsBytes) {
  std::vector<float> floats;
  for (int i = 0; i < 17; ++i) {
    const auto x = float(i);
    floats.insert(floats.end(), {x * 0.25f, float(i % 7) * 0.5f - 1, float(i * i % 64) / 8});
  }
  EXPECT_EQ(values_in<float>(
                decoded(view_alone(bytes_of(kFloats), "ATTRIBUTES", 17, 12, nullptr, "KHR_meshopt_compression"))),
            floats);
  std::vector<uint8_t> bytes;
  uint32_t state = 1;
  const auto random = [&] { return (state = state * 1664525 + 1013904223) >> 16; };
  for (uint32_t i = 0; i < 300; ++i) (void)random();  // the floats' and words' of the generator
  for (uint32_t i = 0; i < 300; ++i) bytes.insert(bytes.end(), {uint8_t(random()), uint8_t(i % 3), uint8_t(i), 255});
  EXPECT_EQ(values_in<uint8_t>(
                decoded(view_alone(bytes_of(kBytes), "ATTRIBUTES", 300, 4, nullptr, "KHR_meshopt_compression"))),
            bytes);
}

TEST(Meshopt, AnyByteOfAVersionOneStreamChangedEndsInASceneOrAnErrorAtItsView) {
  const std::string valid = bytes_of(kFloats);
  for (size_t at = 0; at < valid.size(); ++at)
    for (const bool cut : {false, true}) {
      std::string stream = valid;
      cut ? stream.resize(std::max<size_t>(at, 1)) : void(stream[at] = char(stream[at] ^ 0x55));
      const std::string error = error_of(view_alone(stream, "ATTRIBUTES", 17, 12, nullptr, "KHR_meshopt_compression"));
      ASSERT_TRUE(error.empty() || error.starts_with("/bufferViews/0/extensions/KHR_meshopt_compression")) << error;
    }
}

// ---- Draco ----

struct DracoStream {
  std::string bytes;
  int position = -1, normal = -1, uv = -1, color = -1;  // unique ids
  size_t vertices = 0, triangles = 0;
};

struct DracoChoice {
  bool sequential = false;
  int position_bits = 0;  // 0: exact
};

DracoStream encode_draco(const Grid& grid, const DracoChoice& choice = {}) {
  draco::TriangleSoupMeshBuilder builder;
  const auto faces = int(grid.index.size() / 3);
  builder.Start(faces);
  DracoStream out;
  out.position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  out.normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  out.uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  out.color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  for (int f = 0; f < faces; ++f) {
    const auto* v = &grid.index[size_t(f) * 3];
    const auto set = [&](int id, const auto* values, size_t n) {
      builder.SetAttributeValuesForFace(id, draco::FaceIndex(uint32_t(f)), values + n * v[0], values + n * v[1],
                                        values + n * v[2]);
    };
    set(out.position, grid.positions.data(), 3), set(out.normal, grid.normals.data(), 3),
        set(out.uv, grid.uvs.data(), 2);
    std::vector<uint8_t> colors;
    for (uint32_t i = 0; i < grid.vertices(); ++i)
      colors.insert(colors.end(), {uint8_t(i), uint8_t(i >> 8), uint8_t(3 * i), 255});
    set(out.color, colors.data(), 4);
  }
  const auto mesh = builder.Finalize();
  draco::ExpertEncoder encoder(*mesh);
  encoder.SetEncodingMethod(choice.sequential ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING);
  if (choice.position_bits) encoder.SetAttributeQuantization(out.position, choice.position_bits);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) throw std::runtime_error("not encoded");
  out.bytes.assign(buffer.data(), buffer.size());
  out.vertices = encoder.num_encoded_points(), out.triangles = encoder.num_encoded_faces();
  if (out.vertices == 0) out.vertices = mesh->num_points(), out.triangles = mesh->num_faces();
  return out;
}

json draco_document(const DracoStream& stream) {
  GltfBuilder b;
  const int view = b.view(stream.bytes);
  const auto accessor = [&](const char* type, int component, size_t count) {
    return b.add("accessors", {{"type", type}, {"componentType", component}, {"count", count}});
  };
  const int position = accessor("VEC3", 5126, stream.vertices), normal = accessor("VEC3", 5126, stream.vertices),
            uv = accessor("VEC2", 5126, stream.vertices), color = accessor("VEC4", 5121, stream.vertices);
  b.root["accessors"][size_t(color)]["normalized"] = true;
  b.mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}},
          {"indices", accessor("SCALAR", 5125, 3 * stream.triangles)},
          {"extensions",
           {{"KHR_draco_mesh_compression",
             {{"bufferView", view},
              {"attributes",
               {{"POSITION", stream.position},
                {"NORMAL", stream.normal},
                {"TEXCOORD_0", stream.uv},
                {"COLOR_0", stream.color}}}}}}}});
  return b.document();
}

const char* const kDraco = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";

TEST(Draco, BothMethodsGiveBackTheMesh) {
  for (const bool sequential : {false, true})
    for (const int bits : {0, 14}) {
      const Grid grid(25);
      const DracoStream stream = encode_draco(grid, {sequential, bits});
      const Loaded loaded = load_json(draco_document(stream));
      EXPECT_TRUE(loaded.warnings.empty());
      const TriangleMesh& part = loaded.part();
      ASSERT_EQ(part.positions.size(), grid.vertices());
      ASSERT_EQ(part.triangles.size(), grid.index.size() / 3);
      // Vertices come in another order; the grid's place in x and y names them.
      std::vector<int> seen(grid.vertices());
      const double tolerance = bits ? 25.0 / (1 << bits) : 1e-6;
      for (size_t v = 0; v < part.positions.size(); ++v) {
        const auto i = uint32_t(std::lround(part.positions[v].y)) * grid.n + uint32_t(std::lround(part.positions[v].x));
        ++seen[i];
        EXPECT_NEAR(part.positions[v].z, grid.position(i).z, tolerance);
        EXPECT_NEAR(part.normals[v].x, grid.normals[3 * i], 1e-5);
        EXPECT_NEAR(part.uvs[0][v].x, grid.uvs[2 * i], 1e-6);
        EXPECT_FLOAT_EQ(part.colors[v].x, float(i & 255) / 255);
        EXPECT_FLOAT_EQ(part.colors[v].w, 1);
      }
      EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
      double area = 0;
      for (const auto& t : part.triangles)
        area +=
            0.5 *
            double(cross(part.positions[t[1]] - part.positions[t[0]], part.positions[t[2]] - part.positions[t[0]]).z);
      EXPECT_NEAR(area, 24.0 * 24.0, bits ? 0.1 : 1e-3);
    }
}

TEST(Draco, AStreamThatClaimsMoreThanItsAccessorsIsRefused) {
  const DracoStream stream = encode_draco(Grid(5));
  json document = draco_document(stream);
  for (size_t i = 0; i < 4; ++i) document["accessors"][i]["count"] = 24;
  EXPECT_EQ(error_of(document), std::string(kDraco) +
                                    ": its stream claims 25 vertices and 32 triangles, the accessors have room for 24 "
                                    "vertices and 32 triangles");
  document = draco_document(stream);
  document["accessors"][4]["count"] = 93;
  EXPECT_TRUE(error_of(document).starts_with(std::string(kDraco) + ": its stream claims 25 vertices and 32 triangles"));
  // Accessors as large as the claim do not help where the file is too small for either.
  document = draco_document(stream);
  for (json& accessor : document["accessors"]) accessor["count"] = 4000000000u;
  EXPECT_TRUE(error_of(document).ends_with("--max-memory raises the limit"));
}

TEST(Draco, FaultsAreNamedAtTheirPlace) {
  const DracoStream stream = encode_draco(Grid(5));
  const json valid = draco_document(stream);
  const auto error = [&](const std::string& at, const json& to) {
    json document = valid;
    document[json::json_pointer(at)] = to;
    return error_of(document);
  };
  const std::string at = kDraco;
  EXPECT_EQ(error("/meshes/0/name", "valid"), "");
  EXPECT_EQ(error(at + "/attributes/NORMAL", 99), at + "/attributes/NORMAL: its stream has no attribute 99");
  EXPECT_EQ(error(at + "/attributes/NORMAL", stream.uv),
            at + "/attributes/NORMAL: its stream has 2 components, the accessor 3");
  EXPECT_EQ(error(at + "/attributes/TANGENT", 0),
            at + "/attributes/TANGENT: the primitive has no such attribute, expected one of its own");
  EXPECT_EQ(error(at + "/bufferView", 3), at + "/bufferView: index 3 out of range, /bufferViews has 1");
  EXPECT_EQ(error("/bufferViews/0/byteOffset", 1), "/bufferViews/0: " + std::to_string(stream.bytes.size()) +
                                                       " bytes from byte 1 on exceed the buffer's " +
                                                       std::to_string(stream.bytes.size()) + " bytes");
  json shortened = valid;
  shortened["bufferViews"][0]["byteLength"] = 5;
  EXPECT_EQ(error_of(shortened), at + ": its bytes are no Draco mesh");
  shortened["bufferViews"][0]["byteLength"] = stream.bytes.size() / 2;
  EXPECT_TRUE(error_of(shortened).starts_with(at + ": its Draco stream cannot be decoded"));
}

TEST(Draco, AnyByteOfAStreamChangedEndsInASceneOrAnErrorAtItsPrimitive) {
  std::mt19937 rng(11);
  for (const bool sequential : {false, true}) {
    const DracoStream valid = encode_draco(Grid(8), {sequential, 11});
    for (int round = 0; round < 400; ++round) {
      DracoStream stream = valid;
      for (uint32_t k = 0; k <= rng() % 3; ++k) stream.bytes[rng() % stream.bytes.size()] = char(rng());
      if (rng() % 4 == 0) stream.bytes.resize(rng() % stream.bytes.size() + 1);
      const std::string error = error_of(draco_document(stream));
      ASSERT_TRUE(error.empty() || error.starts_with("/meshes/0/primitives/0")) << error;
    }
  }
}

// ---- Numbers of other widths ----

TEST(Quantization, VerticesOfEveryWidthAreReadAsTheyAreMeant) {
  const auto mesh = [](auto scalar, int component, bool normalized, double one) {
    using T = decltype(scalar);
    const T unit = T(one);
    GltfBuilder b;
    // A quantized VEC3 takes the room of four.
    const auto vertices = [&](std::vector<T> v, const char* type, int columns) {
      const size_t width = columns * sizeof(T) <= 4 ? 4 : 8;
      std::string bytes;
      for (size_t i = 0; i < v.size(); i += size_t(columns)) {
        std::string one_vertex =
            raw_bytes(std::vector<T>(v.begin() + ptrdiff_t(i), v.begin() + ptrdiff_t(i) + columns));
        one_vertex.resize(width);
        bytes += one_vertex;
      }
      return b.add("accessors", {{"bufferView", b.view(bytes, int(width))},
                                 {"type", type},
                                 {"count", 3},
                                 {"componentType", component},
                                 {"normalized", normalized}});
    };
    const T o = 0;
    b.mesh({{"attributes",
             {{"POSITION", vertices({o, o, o, unit, o, o, o, unit, o}, "VEC3", 3)},
              {"TEXCOORD_0", vertices({o, o, unit, o, o, unit}, "VEC2", 2)}}}});
    return load(b);
  };
  const auto check = [](const Loaded& loaded, float one) {
    EXPECT_EQ(loaded.part().positions[1], (Vec3f{one, 0, 0}));
    EXPECT_EQ(loaded.part().positions[2], (Vec3f{0, one, 0}));
    EXPECT_EQ(loaded.part().uvs[0][2].y, one);
  };
  check(mesh(int8_t{}, 5120, true, 127), 1), check(mesh(int8_t{}, 5120, false, 100), 100);
  check(mesh(uint8_t{}, 5121, true, 255), 1), check(mesh(uint8_t{}, 5121, false, 200), 200);
  check(mesh(int16_t{}, 5122, true, 32767), 1), check(mesh(int16_t{}, 5122, false, 30000), 30000);
  check(mesh(uint16_t{}, 5123, true, 65535), 1), check(mesh(uint16_t{}, 5123, false, 60000), 60000);
}

TEST(AccessorFloat64, IsRoundedToFloats) {
  GltfBuilder b;
  const std::vector<double> positions{0, 0, 0, 1.0 / 3, 0, 0, 0, 1e-3, 0};
  b.mesh({{"attributes", {{"POSITION", b.accessor(positions, "VEC3", 5130, 3)}}}});
  const Loaded loaded = load(b);
  EXPECT_EQ(loaded.part().positions[1].x, float(1.0 / 3));
  EXPECT_EQ(loaded.part().positions[2].y, 1e-3f);
  GltfBuilder beyond;
  beyond.mesh({{"attributes",
                {{"POSITION", beyond.accessor(std::vector<double>{0, 0, 0, 1e300, 0, 0, 0, 1, 0}, "VEC3", 5130, 3)}}}});
  EXPECT_EQ(error_of(beyond.document()),
            "/meshes/0/primitives/0/attributes/POSITION: expected finite numbers, the accessor holds others");
}

}  // namespace
}  // namespace alhazen
