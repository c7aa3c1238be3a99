#include "loaders/image_file.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <tuple>

#include "core/error.h"
#include "core/fork_join.h"
#include "loaders/image_library.h"
#include "loaders/openexr_file.h"
#include "loaders/part_file.h"
#include "loaders/png_file.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKnown = "known are .exr, .hdr, .png, .jpg, .tif, .webp, .tga, .bmp, .ppm and others";
constexpr int kDefaultQuality = 95;

// Formats that are known without asking the library that writes most of them, by OpenImageIO's names.
struct CommonFormat {
  const char* extension;
  const char* name;
  bool alpha;
};
constexpr CommonFormat kCommonFormats[] = {{".exr", "openexr", true}, {".png", "png", true},    {".hdr", "hdr", false},
                                           {".jpg", "jpeg", false},   {".jpeg", "jpeg", false}, {".tif", "tiff", true},
                                           {".tiff", "tiff", true},   {".webp", "webp", true},  {".tga", "targa", true},
                                           {".bmp", "bmp", true},     {".ppm", "pnm", false}};

// Pixels a side that a format, or the library that writes it, ends at.
constexpr std::pair<const char*, int> kLargestSides[] = {{"gif", 65535}, {"heif", 16384},  {"ico", 256},
                                                         {"iff", 8192},  {"jpeg", 65500},  {"rla", 32767},
                                                         {"sgi", 65535}, {"targa", 65535}, {"webp", 16383}};

/// Throws WriteError for an extension that no format has.
std::pair<std::string, bool> name_and_alpha(const fs::path& file) {
  const std::string extension = file.extension().string();
  for (const CommonFormat& common : kCommonFormats)
    if (extension == common.extension) return {common.name, common.alpha};
  const auto known = extension.empty() ? std::nullopt : image_library().writer_format(extension);
  if (!known) throw WriteError(file.string(), "unknown image format '" + extension + "'; " + kKnown);
  return {known->name, known->alpha};
}

/// Reads the whole file again: some formats are written without a look at what the disk said.
void check_readable(const fs::path& part) {
  try {
    const auto in = image_library().open_file(part.string());
    const ImageLayout& layout = in->layout();
    const size_t channels = layout.channels.size();
    std::vector<float> pixels(size_t(layout.width) * size_t(layout.height) * channels);
    in->read(int(channels), SampleType::float32, pixels.data(), ptrdiff_t(channels * sizeof(float)));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string("is not complete: ") + error.what());
  }
}

/// Throws std::exception with the library's reason.
void write_by_library(const fs::path& file, const ImageFormat& format, StoredPicture picture,
                      const ImageEncoding& encoding, const Metadata& metadata, PartFile& part) {
  const ImageLibrary& library = image_library();
  picture.texts = metadata;
  picture.texts.emplace_back("oiio:ColorSpace", format.linear ? "Linear" : "sRGB");
  if (!format.premultiplied) picture.numbers.emplace_back("oiio:UnassociatedAlpha", 1);
  if (!format.compressions.empty())
    picture.texts.emplace_back("compression",
                               encoding.compression.empty() ? format.compressions[0] : encoding.compression);
  if (format.quality)
    picture.numbers.emplace_back("CompressionQuality", encoding.quality > 0 ? encoding.quality : kDefaultQuality);
  if (format.name == "jpeg") picture.texts.emplace_back("jpeg:subsampling", "4:4:4");
  const auto writer = library.writer_format(file.extension().string());
  // Encode in memory where that is possible, so that every failing write is seen.
  if (writer && writer->memory) {
    std::vector<uint8_t> bytes;
    library.write(part.path().string(), picture, &bytes);
    return part.write(bytes);
  }
  library.write(part.path().string(), picture, nullptr);
  check_readable(part.path());
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
  write_whole(file, [&](PartFile& part) {
    write_by_library(
        file, format,
        {image.width, image.height, format.alpha ? 4 : 3, SampleType::float32, image.pixels.data(), 4 * sizeof(float)},
        encoding, metadata, part);
  });
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

void write_bytes(const fs::path& file, const ImageFormat& format, int width, int height, int channels,
                 std::span<const uint8_t> bytes, const ImageEncoding& encoding, const Metadata& metadata) {
  write_whole(file, [&](PartFile& part) {
    if (format.name == "png") return part.write(encoded_png(width, height, channels, bytes, metadata));
    write_by_library(file, format, {width, height, channels, SampleType::uint8, bytes.data(), channels}, encoding,
                     metadata, part);
  });
}

void write_exr(const fs::path& file, int width, int height, std::vector<ExrChannel> channels,
               const ImageEncoding& encoding, const Metadata& metadata) {
  const ExrPart all{"", std::move(channels), encoding.compression, metadata};
  write_whole(file, [&](PartFile& part) { part.write(encoded_exr(width, height, {&all, 1})); });
}

template <class T>
std::vector<ExrChannel> exr_channels(const PixelBuffer<T>& image, ExrType type) {
  std::vector<ExrChannel> channels;
  for (const std::string& name : image.channels)
    channels.push_back({name, type, image.pixels.data() + channels.size(), image.channels.size()});
  return channels;
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

ImageFormat image_format(const fs::path& file) {
  ImageFormat format;
  std::tie(format.name, format.alpha) = name_and_alpha(file);
  const auto is = [&](const char* name) { return format.name == name; };
  format.linear = is("openexr") || is("hdr") || is("fits");
  format.premultiplied = is("openexr") || is("tiff");
  format.half = is("openexr");
  format.quality = is("jpeg") || is("webp");
  if (is("openexr")) format.compressions.assign(std::begin(kExrCompressions), std::end(kExrCompressions));
  if (is("tiff")) format.compressions = {"zip", "none", "lzw", "packbits"};
  for (const auto& [name, side] : kLargestSides)
    if (is(name)) format.largest_side = side;
  return format;
}

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
  if (format.name != "openexr" && format.name != "png") preload_image_library();
}

void write_image(const fs::path& file, const ColorImage& image, const ImageEncoding& encoding,
                 const Metadata& metadata) {
  const ImageFormat format = image_format(file);
  if (format.name == "openexr")
    return write_exr(file, image.width, image.height,
                     exr_channels(image, encoding.half ? ExrType::half : ExrType::float32), encoding, metadata);
  if (format.linear) return write_linear(file, format, image, encoding, metadata);
  write_bytes(file, format, image.width, image.height, format.alpha ? 4 : 3, srgb_pixels(format, image), encoding,
              metadata);
}

void write_image(const fs::path& file, const IdImage& image, const ImageEncoding& encoding, const Metadata& metadata) {
  const ImageFormat format = image_format(file);
  if (format.name == "openexr")
    return write_exr(file, image.width, image.height, exr_channels(image, ExrType::uint32), encoding, metadata);
  std::vector<uint8_t> bytes(size_t(image.width) * size_t(image.height) * 3);
  for_each_pixel(image, [&](const uint32_t* in, size_t pixel) {
    const auto color = node_color(in[0]);
    std::copy(color.begin(), color.end(), bytes.begin() + ptrdiff_t(pixel * 3));
  });
  write_bytes(file, format, image.width, image.height, 3, bytes, encoding, metadata);
}

std::vector<uint8_t> encoded_png(const ColorImage& image) {
  return encoded_png(image.width, image.height, 4, srgb_pixels(image_format("image.png"), image), {});
}

std::string image_library_versions() {
  return std::string("OpenImageIO " ALHAZEN_OPENIMAGEIO_VERSION ", OpenEXR ") + openexr_version() + ", libpng " +
         libpng_version();
}

}  // namespace alhazen
