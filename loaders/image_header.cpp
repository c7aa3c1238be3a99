#include "loaders/image_header.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <string>

namespace alhazen {
namespace {

using Bytes = std::span<const uint8_t>;

/// Reads numbers off a file; past its end everything is 0 and `good` false.
struct Reader {
  Bytes file;
  bool good = true;

  uint64_t little(size_t at, size_t bytes) {
    uint64_t value = 0;
    if (at > file.size() || bytes > file.size() - at) return good = false, 0;
    for (size_t k = bytes; k-- > 0;) value = value << 8 | file[at + k];
    return value;
  }
  uint64_t big(size_t at, size_t bytes) {
    uint64_t value = 0;
    if (at > file.size() || bytes > file.size() - at) return good = false, 0;
    for (size_t k = 0; k < bytes; ++k) value = value << 8 | file[at + k];
    return value;
  }
  /// A string that a 0 ends; `at` moves behind it.
  std::string_view text(size_t& at) {
    const auto begin = file.begin() + std::ptrdiff_t(std::min(at, file.size()));
    const auto end = std::find(begin, file.end(), 0);
    if (end == file.end()) return good = false, std::string_view{};
    at = size_t(end - file.begin()) + 1;
    return {reinterpret_cast<const char*>(file.data()) + (begin - file.begin()), size_t(end - begin)};
  }
};

uint64_t saturated(uint64_t a, uint64_t b) {
  constexpr uint64_t most = std::numeric_limits<uint64_t>::max() / 4;
  return b != 0 && a > most / b ? most : a * b;
}

ImageHeader png(Reader& in) {
  constexpr std::array<uint64_t, 7> kChannels{1, 1, 3, 4, 2, 4, 4};  // by colour type; palettes may have alpha
  const uint64_t depth = in.big(24, 1), channels = kChannels[std::min<uint64_t>(in.big(25, 1), 6)];
  ImageHeader header{in.big(16, 4), in.big(20, 4), channels * (depth == 16 ? 2 : 1), 0};
  if (in.big(28, 1) != 0) header.scratch = saturated(header.pixels(), header.bytes_per_pixel);  // interlaced
  return header;
}

/// The frame header, behind however many other segments.
ImageHeader jpeg(Reader& in) {
  for (size_t at = 2; in.good;) {
    if (in.big(at, 1) != 0xff) return in.good = false, ImageHeader{};
    const uint64_t marker = in.big(at + 1, 1);
    const bool padding = marker == 0xff, lone = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) {
      const uint64_t components = in.big(at + 9, 1);
      ImageHeader header{in.big(at + 7, 2), in.big(at + 5, 2), std::max<uint64_t>(components, 3), 0};
      // All coefficients, in 16 bits, where several passes make the picture.
      header.scratch = saturated(header.pixels(), marker % 4 == 2 ? 2 * components : 0);
      return header;
    }
    at += padding ? 1 : lone ? 2 : 2 + in.big(at + 2, 2);
  }
  return {};
}

ImageHeader webp(Reader& in) {
  ImageHeader header;
  const uint64_t four_cc = in.big(12, 4);
  if (four_cc == 0x56503820) {  // "VP8 "
    header.width = in.little(26, 2) & 0x3fff, header.height = in.little(28, 2) & 0x3fff;
  } else if (four_cc == 0x5650384c) {  // "VP8L"
    const uint64_t bits = in.little(21, 4);
    header.width = (bits & 0x3fff) + 1, header.height = (bits >> 14 & 0x3fff) + 1;
  } else if (four_cc == 0x56503858) {  // "VP8X"
    header.width = in.little(24, 3) + 1, header.height = in.little(27, 3) + 1;
  } else {
    in.good = false;
  }
  header.bytes_per_pixel = 4;
  header.scratch = saturated(header.pixels(), 8);
  return header;
}

/// The attributes of a single-part, flat image. Others, and what has no data window, are not read.
ImageHeader openexr(Reader& in) {
  constexpr uint64_t kNotFlat = 0x1800, kMostChannels = 64, kMostLines = 256;
  if (in.little(4, 4) & kNotFlat) return in.good = false, ImageHeader{};
  ImageHeader header;
  uint64_t channels = 0;
  for (size_t at = 8; in.good && in.big(at, 1) != 0;) {
    const std::string_view name = in.text(at), type = in.text(at);
    const size_t size = in.little(at, 4), value = at + 4;
    if (name == "dataWindow" && type == "box2i") {
      const auto corner = [&](size_t k) { return int64_t(int32_t(in.little(value + 4 * k, 4))); };
      const int64_t width = corner(2) - corner(0) + 1, height = corner(3) - corner(1) + 1;
      if (width < 1 || height < 1) return in.good = false, ImageHeader{};
      header.width = uint64_t(width), header.height = uint64_t(height);
    }
    if (name == "channels" && type == "chlist")
      for (size_t c = value; in.good && c < value + size && in.big(c, 1) != 0; c += 16) in.text(c), ++channels;
    at = value + size;
  }
  if (channels < 1 || channels > kMostChannels) in.good = false;
  header.bytes_per_pixel = 16;
  // Lines that are read at once, and the table of where lines or tiles, of a pixel at least, begin.
  header.scratch = saturated(header.width, 4 * channels * kMostLines) + saturated(header.pixels(), 24);
  return header;
}

/// The line "-Y height +X width", in any order and with any signs, after the first empty one.
ImageHeader hdr(Reader& in) {
  constexpr size_t kLongestHead = 1 << 16;
  const std::string text(in.file.begin(), in.file.begin() + std::ptrdiff_t(std::min(in.file.size(), kLongestHead)));
  const size_t blank = text.find("\n\n");
  unsigned first = 0, second = 0;
  char axis = 0;
  if (blank == std::string::npos ||
      std::sscanf(text.c_str() + blank + 2, "%*1[-+]%c %9u %*1[-+]%*c %9u", &axis, &first, &second) != 3)
    return in.good = false, ImageHeader{};
  return {axis == 'Y' ? second : first, axis == 'Y' ? first : second, 12, 0};
}

ImageHeader bmp(Reader& in) {
  const bool short_head = in.little(14, 4) == 12;
  const auto side = [](uint64_t bits) { return uint64_t(std::abs(int64_t(int32_t(bits)))); };
  ImageHeader header{short_head ? in.little(18, 2) : side(in.little(18, 4)),
                     short_head ? in.little(20, 2) : side(in.little(22, 4)), 4, 0};
  header.scratch = saturated(header.pixels(), 4);
  return header;
}

ImageHeader dds(Reader& in) {
  ImageHeader header{in.little(16, 4), in.little(12, 4), 16, 0};
  header.scratch = saturated(header.pixels(), 8);
  return header;
}

ImageHeader ktx2(Reader& in) {
  constexpr uint64_t kMostLevels = 32;
  ImageHeader header{in.little(20, 4), std::max<uint64_t>(in.little(24, 4), 1), 4, 0};
  const uint64_t layers = std::max<uint64_t>(in.little(32, 4), 1), faces = std::max<uint64_t>(in.little(36, 4), 1);
  const uint64_t levels = in.little(40, 4), copies = saturated(saturated(layers, faces), in.little(28, 4) ? 4096 : 1);
  if (levels > kMostLevels) return in.good = false, ImageHeader{};
  header.scratch = saturated(saturated(header.pixels(), 8), copies);                                     // transcoded
  for (uint64_t k = 0; k < levels; ++k) header.scratch += saturated(in.little(80 + 24 * k + 16, 8), 2);  // inflated
  return header;
}

}  // namespace

std::string_view name_of(ImageKind kind) {
  constexpr std::string_view kNames[] = {"png", "jpeg", "webp", "openexr", "hdr", "bmp", "dds", "ktx2"};
  return kNames[size_t(kind)];
}

std::optional<ImageKind> image_kind(std::span<const uint8_t> file) {
  const std::string_view head(reinterpret_cast<const char*>(file.data()), std::min<size_t>(file.size(), 16));
  if (head.starts_with("\x89PNG")) return ImageKind::png;
  if (head.starts_with("\xff\xd8\xff")) return ImageKind::jpeg;
  if (head.starts_with("RIFF") && head.size() >= 12 && head.substr(8, 4) == "WEBP") return ImageKind::webp;
  if (head.starts_with("\x76\x2f\x31\x01")) return ImageKind::openexr;
  if (head.starts_with("#?")) return ImageKind::hdr;
  if (head.starts_with("BM")) return ImageKind::bmp;
  if (head.starts_with("DDS ")) return ImageKind::dds;
  if (head.starts_with("\xABKTX 20\xBB\r\n\x1A\n")) return ImageKind::ktx2;
  return std::nullopt;
}

std::optional<ImageHeader> read_image_header(ImageKind kind, Bytes file) {
  using Read = ImageHeader(Reader&);
  constexpr Read* kReaders[] = {png, jpeg, webp, openexr, hdr, bmp, dds, ktx2};
  Reader in{file};
  const ImageHeader header = kReaders[size_t(kind)](in);
  if (!in.good || header.width == 0 || header.height == 0) return std::nullopt;
  return header;
}

}  // namespace alhazen
