#include "loaders/png_file.h"

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace alhazen {
namespace {

/// All that lives while libpng writes: it leaves by longjmp, which runs no destructors.
struct PngOutput {
  int width, height, channels;
  const uint8_t* pixels;
  std::vector<png_text> texts{};
  png_time time{};
  bool has_time = false;
  std::vector<uint8_t> bytes{};
  std::string reason{};
  bool no_memory = false;
};

void fail(png_structp png, png_const_charp reason) {
  static_cast<PngOutput*>(png_get_error_ptr(png))->reason = reason;
  std::longjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf)), 1);
}

void append(png_structp png, png_bytep from, png_size_t count) {
  auto& output = *static_cast<PngOutput*>(png_get_io_ptr(png));
  try {
    output.bytes.insert(output.bytes.end(), from, from + count);
    return;
  } catch (const std::bad_alloc&) {
    output.no_memory = true;
  }
  png_error(png, "out of memory");
}

void write_all(png_structp png, png_infop info, PngOutput& output) {
  png_set_write_fn(png, &output, append, nullptr);
  png_set_IHDR(png, info, png_uint_32(output.width), png_uint_32(output.height), 8,
               output.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(png, info, output.texts.data(), int(output.texts.size()));
  if (output.has_time) png_set_tIME(png, info, &output.time);
  png_write_info(png, info);
  const size_t row = size_t(output.width) * size_t(output.channels);
  for (int y = 0; y < output.height; ++y) png_write_row(png, output.pixels + size_t(y) * row);
  png_write_end(png, nullptr);
}

/// False where libpng gave up; then there is a reason.
bool write_guarded(PngOutput& output) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, fail, [](png_structp, png_const_charp) {});
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info) return png_destroy_write_struct(&png, nullptr), output.no_memory = true, false;
  const bool ok = setjmp(png_jmpbuf(png)) == 0;
  if (ok) write_all(png, info, output);
  png_destroy_write_struct(&png, &info);
  return ok;
}

/// PNG has its own places and names for two of them.
void add_metadata(const Metadata& metadata, PngOutput& output) {
  for (const auto& [name, value] : metadata) {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
    if (name == "DateTime" &&
        std::sscanf(value.c_str(), "%d:%d:%d %d:%d:%d", &year, &month, &day, &hour, &minute, &second) == 6) {
      output.time = {png_uint_16(year), png_byte(month),  png_byte(day),
                     png_byte(hour),    png_byte(minute), png_byte(second)};
      output.has_time = true;
      continue;
    }
    png_text text = {};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = const_cast<char*>(name == "ImageDescription" ? "Description" : name.c_str());  // only read
    text.text = const_cast<char*>(value.c_str());
    text.text_length = value.size();
    output.texts.push_back(text);
  }
}

}  // namespace

std::vector<uint8_t> encoded_png(int width, int height, int channels, std::span<const uint8_t> pixels,
                                 const Metadata& metadata) {
  PngOutput output{.width = width, .height = height, .channels = channels, .pixels = pixels.data()};
  add_metadata(metadata, output);
  if (write_guarded(output)) return std::move(output.bytes);
  if (output.no_memory) throw std::bad_alloc();
  throw std::runtime_error(output.reason);
}

const char* libpng_version() { return png_get_libpng_ver(nullptr); }

}  // namespace alhazen
