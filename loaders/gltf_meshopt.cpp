#include "loaders/gltf_meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "loaders/meshopt_vertices.h"

namespace alhazen {
namespace {

/// No stream is shorter: 2 bits for 256 bytes of attributes, a byte for a triangle, a byte for an index.
uint64_t shortest_stream(const std::string& mode, uint64_t count, uint64_t stride) {
  return mode == "ATTRIBUTES" ? count * stride / 1024 : mode == "TRIANGLES" ? count / 3 : count;
}

/// Nothing for a stream that is malformed.
std::optional<Bytes> decode(const std::string& mode, size_t count, size_t stride, std::span<const uint8_t> stream) {
  if (mode == "ATTRIBUTES" && is_version_1(stream)) return decode_vertices_1(stream, count, stride);
  Bytes out(count * stride);
  const auto all = [&](auto decoder) { return decoder(out.data(), count, stride, stream.data(), stream.size()); };
  using Decoder = int(void*, size_t, size_t, const unsigned char*, size_t);
  const int error = mode == "ATTRIBUTES"  ? all(static_cast<Decoder*>(meshopt_decodeVertexBuffer))
                    : mode == "TRIANGLES" ? all(static_cast<Decoder*>(meshopt_decodeIndexBuffer))
                                          : all(static_cast<Decoder*>(meshopt_decodeIndexSequence));
  if (error != 0) return std::nullopt;
  return out;
}

/// KHR_meshopt_compression, appendix B, filter 4: Y, Co, Cg and alpha of one pixel, whose highest bit but alpha's own
/// says how many bits there are, to red, green, blue and alpha that fill T.
template <class T>
void undo_color_filter(T* pixel) {
  using Signed = std::make_signed_t<T>;
  const int y = pixel[0], co = Signed(pixel[1]), cg = Signed(pixel[2]), a = pixel[3];
  int ones = a;  // all bits from alpha's highest on: the scale of the other three
  for (int shift = 1; shift < 16; shift *= 2) ones |= ones >> shift;
  const float scale = ones ? float(std::numeric_limits<T>::max()) / float(ones) : 0;
  const int green_less = y - cg, alpha = (a << 1 & ones) | (a & 1);
  const int channels[4] = {green_less + co, y + cg, green_less - co, alpha};
  for (int k = 0; k < 4; ++k)
    pixel[k] = T(std::clamp(std::lround(float(channels[k]) * scale), 0L, long{std::numeric_limits<T>::max()}));
}

template <class T>
void undo_color_filter(Bytes& bytes) {
  for (size_t at = 0; at < bytes.size(); at += 4 * sizeof(T)) {
    T pixel[4];
    std::memcpy(pixel, &bytes[at], sizeof pixel);
    undo_color_filter(pixel);
    std::memcpy(&bytes[at], pixel, sizeof pixel);
  }
}

void undo_filter(const std::string& filter, Bytes& bytes, size_t count, size_t stride) {
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count * stride / 4, 4);
  if (filter == "COLOR") stride == 4 ? undo_color_filter<uint8_t>(bytes) : undo_color_filter<uint16_t>(bytes);
}

}  // namespace

std::optional<JsonRef> meshopt_extension(const JsonRef& buffer_view) {
  if (auto e = buffer_view.extension("KHR_meshopt_compression")) return e;
  return buffer_view.extension("EXT_meshopt_compression");
}

uint64_t meshopt_size(const JsonRef& r, std::span<const uint8_t> stream) {
  const auto count = r["count"].as<uint64_t>(), stride = r["byteStride"].as<uint64_t>();
  if (shortest_stream(r["mode"].as<std::string>(), count, stride) > stream.size())
    r["count"].fail(std::to_string(count) + " elements are more than a stream of " + std::to_string(stream.size()) +
                    " bytes can hold");
  return count * stride;
}

Bytes decode_meshopt(const JsonRef& r, std::span<const uint8_t> stream) {
  const auto mode = r["mode"].as<std::string>();
  const auto count = r["count"].as<uint64_t>(), stride = r["byteStride"].as<uint64_t>();
  (void)meshopt_size(r, stream);
  auto out = decode(mode, count, stride, stream);
  if (!out)
    r.fail("its bytes are no stream of " + std::to_string(count) + " " + mode + " elements of " +
           std::to_string(stride) + " bytes");
  undo_filter(r.get("filter", std::string("NONE")), *out, count, stride);
  return std::move(*out);
}

}  // namespace alhazen
