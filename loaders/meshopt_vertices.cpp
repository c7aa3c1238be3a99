#include "loaders/meshopt_vertices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace alhazen {
namespace {

constexpr uint8_t kVersion1 = 0xa1;
constexpr size_t kGroup = 16, kShortestTail = 24, kMostInBlock = 256, kBlockBytes = 8192;

/// The part of a stream that is left; reading beyond its end gives nothing and says so.
class Reader {
 public:
  explicit Reader(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  /// Empty where there are fewer than n.
  std::span<const uint8_t> take(size_t n) {
    if (n > bytes_.size()) failed_ = true;
    if (failed_) return {};
    const auto taken = bytes_.first(n);
    bytes_ = bytes_.subspan(n);
    return taken;
  }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] bool at_end() const { return !failed_ && bytes_.empty(); }

 private:
  std::span<const uint8_t> bytes_;
  bool failed_ = false;
};

/// Delta i of a group that is packed in `bits` each: from the lowest on where there is one, else from the highest.
uint8_t packed(std::span<const uint8_t> bytes, int bits, size_t i) {
  const size_t in_byte = 8 / size_t(bits), k = i % in_byte;
  const size_t shift = bits == 1 ? k : (in_byte - 1 - k) * size_t(bits);
  return uint8_t(bytes[i / in_byte] >> shift & ((1 << bits) - 1));
}

/// 16 deltas of `bits` each; the largest number stands for one that follows as a byte.
void read_group(Reader& in, int bits, uint8_t* deltas) {
  if (bits == 0) return void(std::fill_n(deltas, kGroup, uint8_t{0}));
  const auto bytes = in.take(kGroup * size_t(bits) / 8);
  if (in.failed()) return;
  if (bits == 8) return void(std::copy(bytes.begin(), bytes.end(), deltas));
  for (size_t i = 0; i < kGroup; ++i) {
    deltas[i] = packed(bytes, bits, i);
    if (deltas[i] != (1 << bits) - 1) continue;
    const auto whole = in.take(1);
    if (in.failed()) return;
    deltas[i] = whole[0];
  }
}

/// The deltas of one byte position through a block, as its control mode has them.
void read_deltas(Reader& in, int control, size_t count, uint8_t* deltas) {
  constexpr std::array<std::array<int, 4>, 2> kBits{{{0, 1, 2, 4}, {1, 2, 4, 8}}};
  if (control == 2) return void(std::fill_n(deltas, count, uint8_t{0}));
  if (control == 3) {
    const auto bytes = in.take(count);
    return void(std::copy(bytes.begin(), bytes.end(), deltas));
  }
  const size_t groups = (count + kGroup - 1) / kGroup;
  const auto header = in.take((groups + 3) / 4);
  for (size_t g = 0; g < groups && !in.failed(); ++g)
    read_group(in, kBits[size_t(control)][header[g / 4] >> (g % 4 * 2) & 3], deltas + g * kGroup);
}

template <class T>
T unzigzag(T v) {
  return T(v & 1 ? ~(v >> 1) : v >> 1);
}

/// The value after `before`, both little-endian in 4 bytes.
uint32_t next_channel(uint8_t mode, uint32_t before, uint32_t delta) {
  uint32_t after = 0;
  if (mode % 16 == 2) return before ^ std::rotr(delta, mode / 16);
  const int bits = mode == 0 ? 8 : 16;
  for (int shift = 0; shift < 32; shift += bits) {
    const uint32_t mask = (1u << bits) - 1, d = delta >> shift & mask;
    const uint32_t step = bits == 8 ? uint32_t(unzigzag(uint8_t(d))) : uint32_t(unzigzag(uint16_t(d)));
    after |= (((before >> shift) + step) & mask) << shift;
  }
  return after;
}

bool is_known(uint8_t channel_mode) { return channel_mode <= 1 || channel_mode % 16 == 2; }

}  // namespace

bool is_version_1(std::span<const uint8_t> stream) { return !stream.empty() && stream[0] == kVersion1; }

std::optional<Bytes> decode_vertices_1(std::span<const uint8_t> stream, size_t count, size_t stride) {
  const size_t channels = stride / 4, tail = stride + channels, padded = std::max(tail, kShortestTail);
  if (!is_version_1(stream) || stream.size() < 1 + padded) return std::nullopt;
  const auto modes = stream.last(channels);
  if (!std::all_of(modes.begin(), modes.end(), is_known)) return std::nullopt;
  std::vector<uint32_t> element(channels);
  std::memcpy(element.data(), stream.last(tail).data(), stride);

  Bytes out(count * stride);
  Reader in(stream.subspan(1, stream.size() - 1 - padded));
  const size_t most = std::min(kBlockBytes / stride / kGroup * kGroup, kMostInBlock);
  std::vector<uint8_t> deltas(stride * kMostInBlock);  // position by position
  for (size_t first = 0; first < count; first += most) {
    const size_t n = std::min(most, count - first);
    const auto control = in.take(channels);
    for (size_t k = 0; k < stride && !in.failed(); ++k)
      read_deltas(in, control[k / 4] >> (k % 4 * 2) & 3, n, &deltas[k * kMostInBlock]);
    if (in.failed()) return std::nullopt;
    for (size_t i = 0; i < n; ++i)
      for (size_t c = 0; c < channels; ++c) {
        uint32_t delta = 0;
        for (size_t b = 0; b < 4; ++b) delta |= uint32_t{deltas[(4 * c + b) * kMostInBlock + i]} << 8 * b;
        element[c] = next_channel(modes[c], element[c], delta);
        std::memcpy(&out[(first + i) * stride + 4 * c], &element[c], 4);
      }
  }
  if (!in.at_end()) return std::nullopt;
  return out;
}

}  // namespace alhazen
