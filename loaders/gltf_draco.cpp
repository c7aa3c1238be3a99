#include "loaders/gltf_draco.h"

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <utility>

namespace alhazen {
namespace {

struct MeshSize {
  uint64_t vertices, triangles;
};

// ---- What a stream claims ----

/// Numbers of fixed size, which variable ones took the place of in later versions.
bool read_count(draco::DecoderBuffer& in, bool fixed, uint32_t& count) {
  return fixed ? in.Decode(&count) : draco::DecodeVarint(&count, &in);
}

bool read_sequential(draco::DecoderBuffer& in, uint16_t version, uint32_t& vertices, uint32_t& triangles) {
  const bool fixed = version < DRACO_BITSTREAM_VERSION(2, 2);
  return read_count(in, fixed, triangles) && read_count(in, fixed, vertices);
}

bool read_edgebreaker(draco::DecoderBuffer& in, uint16_t version, uint32_t& vertices, uint32_t& triangles) {
  const bool fixed = version < DRACO_BITSTREAM_VERSION(2, 0);
  uint8_t traversal = 0;
  uint32_t new_vertices = 0;
  return in.Decode(&traversal) && (version >= DRACO_BITSTREAM_VERSION(2, 2) || read_count(in, fixed, new_vertices)) &&
         read_count(in, fixed, vertices) && read_count(in, fixed, triangles);
}

/// The sizes in the stream's head, at least what its decoder takes memory for; none where it has no head of a mesh.
std::optional<MeshSize> claimed_size(std::span<const uint8_t> stream) {
  draco::DecoderBuffer in;
  in.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  char magic[5];
  uint8_t major = 0, minor = 0, kind = 0, method = 0;
  uint16_t flags = 0;
  const bool head = in.Decode(magic, sizeof magic) && std::memcmp(magic, "DRACO", sizeof magic) == 0 &&
                    in.Decode(&major) && in.Decode(&minor) && in.Decode(&kind) && in.Decode(&method) &&
                    in.Decode(&flags);
  if (!head || kind != draco::TRIANGULAR_MESH) return std::nullopt;
  const uint16_t version = DRACO_BITSTREAM_VERSION(major, minor);
  in.set_bitstream_version(version);
  if (version >= DRACO_BITSTREAM_VERSION(1, 3) && (flags & METADATA_FLAG_MASK)) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&in, &metadata)) return std::nullopt;
  }
  uint32_t vertices = 0, triangles = 0;
  const bool read = method == draco::MESH_SEQUENTIAL_ENCODING ? read_sequential(in, version, vertices, triangles)
                                                              : read_edgebreaker(in, version, vertices, triangles);
  if (!read) return std::nullopt;
  return MeshSize{vertices, triangles};
}

// ---- Decoding ----

std::string text_of(const MeshSize& size) {
  return std::to_string(size.vertices) + " vertices and " + std::to_string(size.triangles) + " triangles";
}

/// `most` is what the accessors have room for.
void check_size(const JsonRef& r, const char* verb, const MeshSize& found, const MeshSize& most) {
  if (found.vertices > most.vertices || found.triangles > most.triangles)
    r.fail(std::string("its stream ") + verb + " " + text_of(found) + ", the accessors have room for " + text_of(most));
}

std::unique_ptr<draco::Mesh> decode(const JsonRef& r, std::span<const uint8_t> stream, const MeshSize& most) {
  const auto claimed = claimed_size(stream);
  if (!claimed) r.fail("its bytes are no Draco mesh");
  check_size(r, "claims", *claimed, most);
  draco::DecoderBuffer in;
  in.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&in);
  if (!mesh.ok()) r.fail("its Draco stream cannot be decoded: " + mesh.status().error_msg_string());
  check_size(r, "holds", {mesh.value()->num_points(), mesh.value()->num_faces()}, most);
  return std::move(mesh).value();
}

std::vector<uint32_t> indices_of(const JsonRef& r, const draco::Mesh& mesh) {
  std::vector<uint32_t> index;
  index.reserve(size_t{3} * mesh.num_faces());
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (const draco::PointIndex& p : mesh.face(f)) {
      if (p.value() >= mesh.num_points())
        r.fail("its stream names vertex " + std::to_string(p.value()) + " of " + std::to_string(mesh.num_points()));
      index.push_back(p.value());
    }
  return index;
}

/// The attribute of every vertex, as numbers of type T, one after the other; nothing where they do not fit T.
template <class T>
Bytes values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
  const size_t components = attribute.num_components();
  Bytes out(sizeof(T) * components * mesh.num_points());
  std::vector<T> vertex(components);
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    if (!attribute.ConvertValue(attribute.mapped_index(p), int8_t(components), vertex.data())) return {};
    std::memcpy(&out[p.value() * sizeof(T) * components], vertex.data(), sizeof(T) * components);
  }
  return out;
}

/// Adds the attribute `name`, whose accessor `shape` says what its numbers are.
void add_attribute(DracoPrimitive& primitive, const JsonRef& r, const std::string& name, const AccessorView& shape,
                   const draco::Mesh& mesh) {
  const auto id = r["attributes"][name].as<uint32_t>();
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
  if (!attribute) r["attributes"][name].fail("its stream has no attribute " + std::to_string(id));
  if (attribute->num_components() != shape.components)
    r["attributes"][name].fail("its stream has " + std::to_string(attribute->num_components()) +
                               " components, the accessor " + std::to_string(shape.components));
  Bytes values =
      with_component_type(shape.type, [&](auto component) { return values_of<decltype(component)>(mesh, *attribute); });
  if (values.empty() && mesh.num_points() > 0)
    r["attributes"][name].fail("its stream has numbers that do not fit the accessor's component type");
  AccessorView view;
  view.count = mesh.num_points();
  view.components = view.rows = shape.components;
  view.type = shape.type;
  view.normalized = shape.normalized;
  view.stride = shape.components * component_size(shape.type);
  view.data = values.data();
  primitive.owned.push_back(std::move(values));
  primitive.attributes[name] = std::move(view);
}

}  // namespace

DracoPrimitive decode_draco(const JsonRef& primitive, const GltfBuffers& buffers) {
  const JsonRef r = *primitive.extension("KHR_draco_mesh_compression"), attributes = primitive["attributes"];
  const AccessorView& position = buffers.accessor(attributes["POSITION"].as<int>());
  const auto index = primitive.find("indices");
  // A strip has up to as many triangles as indices.
  const uint64_t indices = index ? buffers.accessor(index->as<int>()).count : position.count;
  const MeshSize most{position.count, primitive.get("mode", 4) == 4 ? indices / 3 : indices};
  try {
    const auto mesh = decode(r, buffers.buffer_view(r["bufferView"].as<int>()), most);
    DracoPrimitive decoded;
    decoded.index = indices_of(r, *mesh);
    for (const auto& item : r["attributes"].value().items()) {
      if (!attributes.has(item.key()))
        r["attributes"][item.key()].fail("the primitive has no such attribute, expected one of its own");
      const AccessorView& shape = buffers.accessor(attributes[item.key()].as<int>());
      if (shape.rows == shape.components) add_attribute(decoded, r, item.key(), shape, *mesh);
    }
    return decoded;
  } catch (const std::bad_alloc&) {
    r.fail("its stream needs more memory than there is");
  }
}

}  // namespace alhazen
