#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "loaders/oiio/open_image_io.h"

namespace alhazen::oiio {
namespace {

// Written by OpenImageIO, but no place for a picture: its numbers, its terminal, one channel alone, nothing at all.
constexpr std::array kNoPictures{"null", "term", "zfile"};

std::unique_ptr<OIIO::ImageOutput> create_output(const std::string& extension) {
  auto out = extension.empty() ? nullptr : OIIO::ImageOutput::create("image" + extension);
  (void)OIIO::geterror();  // fetched, or it is printed at exit
  if (out && std::find(kNoPictures.begin(), kNoPictures.end(), std::string(out->format_name())) != kNoPictures.end())
    return nullptr;
  return out;
}

std::string extension_of(const std::string& path) {
  const size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(dot);
}

}  // namespace

std::optional<ImageWriterFormat> writer_format(const std::string& extension) {
  const auto out = create_output(extension);
  if (!out) return std::nullopt;
  // TIFF is not finished in memory by OpenImageIO 2.4.
  const std::string name = out->format_name();
  return ImageWriterFormat{name, out->supports("alpha") != 0, out->supports("ioproxy") && name != "tiff"};
}

void write(const std::string& path, const StoredPicture& picture, std::vector<uint8_t>* bytes) {
  // Declared first, since what `out` writes at its end goes there.
  std::optional<OIIO::Filesystem::IOVecOutput> memory;
  const auto out = create_output(extension_of(path));
  if (!out) throw std::runtime_error("unknown image format");
  const auto check = [&](bool ok) {
    if (!ok) throw std::runtime_error(out->geterror());
  };
  if (bytes) check(out->set_ioproxy(&memory.emplace(*bytes)));
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, type_of(picture.type));
  for (const auto& [name, value] : picture.numbers) spec.attribute(name, value);
  for (const auto& [name, value] : picture.texts) spec.attribute(name, value);
  check(out->open(path, spec));
  check(out->write_image(type_of(picture.type), picture.pixels, picture.stride));
  check(out->close());
}

}  // namespace alhazen::oiio
