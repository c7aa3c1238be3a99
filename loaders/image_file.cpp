#include "loaders/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/fork_join.h"
#include "loaders/part_file.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKnown = "known are .exr, .hdr, .png, .jpg, .tif, .webp, .tga, .bmp, .ppm and others";
constexpr int kDefaultQuality = 95;
constexpr float kLargestHalf = 65504;

// Written by OpenImageIO, but no place for a picture: its numbers, its terminal, one channel alone, nothing at all.
constexpr std::array kNoPictures{"null", "term", "zfile"};

// Pixels a side that a format, or the library that writes it, ends at.
constexpr std::pair<const char*, int> kLargestSides[] = {{"gif", 65535}, {"heif", 16384},  {"ico", 256},
                                                         {"iff", 8192},  {"jpeg", 65500},  {"rla", 32767},
                                                         {"sgi", 65535}, {"targa", 65535}, {"webp", 16383}};

std::unique_ptr<OIIO::ImageOutput> create_output(const fs::path& file) {
  const std::string extension = file.extension().string();
  auto out = extension.empty() ? nullptr : OIIO::ImageOutput::create("image" + extension);
  (void)OIIO::geterror();  // fetched, or it is printed at exit
  if (!out || std::find(kNoPictures.begin(), kNoPictures.end(), std::string(out->format_name())) != kNoPictures.end())
    throw WriteError(file.string(), "unknown image format '" + extension + "'; " + kKnown);
  return out;
}

ImageFormat format_of(const OIIO::ImageOutput& out) {
  ImageFormat format;
  format.name = out.format_name();
  const auto is = [&](const char* name) { return format.name == name; };
  format.linear = is("openexr") || is("hdr") || is("fits");
  format.alpha = out.supports("alpha") != 0;
  format.premultiplied = is("openexr") || is("tiff");
  format.half = is("openexr");
  format.quality = is("jpeg") || is("webp");
  if (is("openexr"))
    format.compressions = {"zip", "none", "rle", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"};
  if (is("tiff")) format.compressions = {"zip", "none", "lzw", "packbits"};
  for (const auto& [name, side] : kLargestSides)
    if (is(name)) format.largest_side = side;
  return format;
}

/// What every format is told of a picture; the caller adds what is in its channels.
OIIO::ImageSpec spec_for(const ImageFormat& format, int width, int height, int channels, OIIO::TypeDesc type,
                         const ImageEncoding& encoding, const Metadata& metadata) {
  OIIO::ImageSpec spec(width, height, channels, type);
  spec.attribute("oiio:ColorSpace", format.linear ? "Linear" : "sRGB");
  if (!format.premultiplied) spec.attribute("oiio:UnassociatedAlpha", 1);
  if (!format.compressions.empty())
    spec.attribute("compression", encoding.compression.empty() ? format.compressions[0] : encoding.compression);
  if (format.quality) spec.attribute("CompressionQuality", encoding.quality > 0 ? encoding.quality : kDefaultQuality);
  if (format.name == "jpeg") spec.attribute("jpeg:subsampling", "4:4:4");
  for (const auto& [name, value] : metadata) spec.attribute(name, value);
  return spec;
}

/// OpenImageIO's error, without its program's names and line breaks.
std::string one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "cannot be written" : text;
}

/// Reads the whole file again: some formats are written without a look at what the disk said.
void check_readable(const fs::path& file, const fs::path& part) {
  const auto in = OIIO::ImageInput::open(part.string());
  if (!in) throw WriteError(file.string(), "is not complete: " + one_line(OIIO::geterror()));
  std::vector<float> pixels(size_t(in->spec().width) * size_t(in->spec().height) * size_t(in->spec().nchannels));
  if (!in->read_image(0, 0, 0, in->spec().nchannels, OIIO::TypeDesc::FLOAT, pixels.data()))
    throw WriteError(file.string(), "is not complete: " + one_line(in->geterror()));
}

/// Pixels on their way to a format; `stride` in bytes, only the channels that `spec` has are written.
struct StoredPixels {
  OIIO::ImageSpec spec;
  OIIO::TypeDesc type;
  const void* pixels;
  OIIO::stride_t stride;
};

/// To what `out` writes to under that name. `file` is what errors speak of.
void encode(const fs::path& file, OIIO::ImageOutput& out, const fs::path& name, const StoredPixels& stored) {
  const auto check = [&](bool ok) {
    if (!ok) throw WriteError(file.string(), one_line(out.geterror()));
  };
  check(out.open(name.string(), stored.spec));
  check(out.write_image(stored.type, stored.pixels, stored.stride));
  check(out.close());
}

std::vector<unsigned char> encoded(const fs::path& file, OIIO::ImageOutput& out, const fs::path& name,
                                   const StoredPixels& stored) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput writer(bytes);
  if (!out.set_ioproxy(&writer)) throw WriteError(file.string(), one_line(out.geterror()));
  encode(file, out, name, stored);
  return bytes;
}

void write_pixels(const fs::path& file, const StoredPixels& stored) {
  PartFile part(file);
  const auto out = create_output(file);  // goes first: what it writes at its end goes with the part
  // Encode in memory, so that every failing write is seen; not TIFF, which OpenImageIO 2.4 does not finish there.
  if (out->supports("ioproxy") && std::string(out->format_name()) != "tiff") {
    part.write(encoded(file, *out, part.path(), stored));
  } else {
    encode(file, *out, part.path(), stored);
    check_readable(file, part.path());
  }
  part.commit();
}

uint8_t to_byte(float v) { return uint8_t(std::lround(255.0f * std::clamp(std::isnan(v) ? 0.0f : v, 0.0f, 1.0f))); }

/// f(pixel in, index of the pixel), rows in parallel.
template <class T, class F>
void for_each_pixel(const PixelBuffer<T>& image, F f) {
  const ForkJoin order;
  tbb::parallel_for(0, image.height, order.task([&](int y) {
    for (int x = 0; x < image.width; ++x) f(image.at(x, y), size_t(y) * size_t(image.width) + size_t(x));
  }));
}

/// R, G, B, A of one pixel as sRGB bytes: straight colour, or the encoded colour times alpha.
std::array<uint8_t, 4> srgb_bytes(const float* in, bool with_alpha, bool premultiplied) {
  const float alpha = in[3], divisor = with_alpha && alpha > 0 ? alpha : 1.0f;
  std::array<uint8_t, 4> out{};
  for (size_t c = 0; c < 3; ++c) {
    const float v = in[c] / divisor;
    const float encoded = srgb_from_linear(v > 0 ? std::min(v, 1.0f) : 0.0f);
    out[c] = to_byte(premultiplied ? encoded * divisor : encoded);
  }
  out[3] = to_byte(alpha);
  return out;
}

void write_linear(const fs::path& file, const ImageFormat& format, const ColorImage& image,
                  const ImageEncoding& encoding, const Metadata& metadata) {
  const int channels = format.alpha ? 4 : 3;
  const auto spec = spec_for(format, image.width, image.height, channels,
                             encoding.half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT, encoding, metadata);
  if (!encoding.half) return write_pixels(file, {spec, OIIO::TypeDesc::FLOAT, image.pixels.data(), 4 * sizeof(float)});
  std::vector<float> clamped(image.pixels);  // brighter values would become infinite
  for (float& v : clamped) v = std::clamp(v, -kLargestHalf, kLargestHalf);
  write_pixels(file, {spec, OIIO::TypeDesc::FLOAT, clamped.data(), 4 * sizeof(float)});
}

/// As many channels as the format keeps: 3 or 4.
std::vector<uint8_t> srgb_pixels(const ImageFormat& format, const ColorImage& image) {
  const size_t channels = format.alpha ? 4 : 3;
  std::vector<uint8_t> bytes(size_t(image.width) * size_t(image.height) * channels);
  for_each_pixel(image, [&](const float* in, size_t pixel) {
    const auto out = srgb_bytes(in, format.alpha, format.premultiplied);
    std::copy_n(out.begin(), channels, bytes.begin() + ptrdiff_t(pixel * channels));
  });
  return bytes;
}

void write_srgb(const fs::path& file, const ImageFormat& format, const ColorImage& image, const ImageEncoding& encoding,
                const Metadata& metadata) {
  const std::vector<uint8_t> bytes = srgb_pixels(format, image);
  const int channels = format.alpha ? 4 : 3;
  const auto spec = spec_for(format, image.width, image.height, channels, OIIO::TypeDesc::UINT8, encoding, metadata);
  write_pixels(file, {spec, OIIO::TypeDesc::UINT8, bytes.data(), channels});
}

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::array<uint8_t, 3> node_color(uint32_t node) noexcept {
  constexpr uint32_t mask = 0xffffff;
  uint32_t h = (node + 1) & mask;  // each step is a bijection of 24 bits that keeps 0
  h = (h * 0x9e3779u) & mask, h ^= h >> 12;
  h = (h * 0x85ebcbu) & mask, h ^= h >> 11;
  h = (h * 0xc2b2afu) & mask, h ^= h >> 12;
  return {uint8_t(h >> 16), uint8_t(h >> 8), uint8_t(h)};
}

ImageFormat image_format(const fs::path& file) { return format_of(*create_output(file)); }

void check_encoding(const fs::path& file, const ImageEncoding& encoding) {
  const ImageFormat format = image_format(file);
  const std::string extension = file.extension().string();
  if (encoding.half && !format.half) throw UsageError("half floats need an .exr file, not " + extension);
  if (encoding.quality != 0 && !format.quality) throw UsageError(extension + " has no quality to choose");
  const auto& known = format.compressions;
  if (encoding.compression.empty() || std::find(known.begin(), known.end(), encoding.compression) != known.end())
    return;
  throw UsageError(known.empty() ? extension + " has no compression to choose"
                                 : extension + " has no compression '" + encoding.compression + "', expected one of " +
                                       list(known));
}

void check_writable(const fs::path& file, int width, int height) {
  const ImageFormat format = image_format(file);
  if (std::max(width, height) > format.largest_side)
    throw WriteError(file.string(),
                     "holds pictures of " + std::to_string(format.largest_side) + " pixels a side at most");
  const PartFile part(file);
}

void write_image(const fs::path& file, const ColorImage& image, const ImageEncoding& encoding,
                 const Metadata& metadata) {
  const ImageFormat format = image_format(file);
  (format.linear ? write_linear : write_srgb)(file, format, image, encoding, metadata);
}

void write_image(const fs::path& file, const IdImage& image, const ImageEncoding& encoding, const Metadata& metadata) {
  const ImageFormat format = image_format(file);
  if (format.name == "openexr") {
    auto spec = spec_for(format, image.width, image.height, 3, OIIO::TypeDesc::UINT32, encoding, metadata);
    spec.channelnames = image.channels;
    spec.alpha_channel = spec.z_channel = -1;
    return write_pixels(file, {spec, OIIO::TypeDesc::UINT32, image.pixels.data(), 3 * sizeof(uint32_t)});
  }
  std::vector<uint8_t> bytes(size_t(image.width) * size_t(image.height) * 3);
  for_each_pixel(image, [&](const uint32_t* in, size_t pixel) {
    const auto color = node_color(in[0]);
    std::copy(color.begin(), color.end(), bytes.begin() + ptrdiff_t(pixel * 3));
  });
  const auto spec = spec_for(format, image.width, image.height, 3, OIIO::TypeDesc::UINT8, encoding, metadata);
  write_pixels(file, {spec, OIIO::TypeDesc::UINT8, bytes.data(), 3});
}

std::vector<uint8_t> encoded_png(const ColorImage& image) {
  const fs::path name = "image.png";
  const auto out = create_output(name);
  const ImageFormat format = format_of(*out);
  const std::vector<uint8_t> bytes = srgb_pixels(format, image);
  const auto spec = spec_for(format, image.width, image.height, 4, OIIO::TypeDesc::UINT8, {}, {});
  return encoded(name, *out, name, {spec, OIIO::TypeDesc::UINT8, bytes.data(), 4});
}

std::string image_library_version() {
  const int v = OIIO::openimageio_version();
  return "OpenImageIO " + std::to_string(v / 10000) + "." + std::to_string(v / 100 % 100) + "." +
         std::to_string(v % 100);
}

}  // namespace alhazen
