#include "loaders/read_picture.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/error.h"
#include "loaders/image_library.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

/// What `read` makes of the open file; the library's reasons become errors that name it.
template <class Image>
Image read_file(const std::filesystem::path& file, Image (*read)(const std::string& file, ImageReader& in)) {
  const ImageLibrary& library = image_library();
  try {
    return read(file.string(), *library.open_file(file.string()));
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error& reason) {
    throw LoadError(file.string(), "", reason.what());
  }
}

ColorImage read_color(const std::string& file, ImageReader& in) {
  const ImageLayout& layout = in.layout();
  if (layout.channels.size() < 3) throw LoadError(file, "", "is no colour picture");
  ColorImage image{layout.width, layout.height, {"R", "G", "B"}, {}};
  image.pixels.resize(size_t(layout.width) * size_t(layout.height) * 3);
  in.read(3, SampleType::float32, image.pixels.data(), 3 * sizeof(float));
  if (layout.type == SampleType::uint8) std::ranges::transform(image.pixels, image.pixels.begin(), linear_from_srgb);
  return image;
}

IdImage read_ids(const std::string& file, ImageReader& in) {
  const ImageLayout& layout = in.layout();
  IdImage image{layout.width, layout.height, {"node", "primitive", "material"}, {}};
  std::array<size_t, 3> from;
  for (size_t c = 0; c < 3; ++c) {
    const auto channel = std::ranges::find(layout.channels, image.channels[c]);
    if (channel == layout.channels.end() || layout.type != SampleType::uint32)
      throw LoadError(file, "", "is no scene signature: expected the 32-bit UINT channels node, primitive, material");
    from[c] = size_t(channel - layout.channels.begin());
  }
  const size_t pixels = size_t(layout.width) * size_t(layout.height), channels = layout.channels.size();
  std::vector<uint32_t> stored(pixels * channels);
  in.read(int(channels), SampleType::uint32, stored.data(), ptrdiff_t(channels * sizeof(uint32_t)));
  image.pixels.resize(3 * pixels);
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = stored[i / 3 * channels + from[i % 3]];
  return image;
}

}  // namespace

ColorImage read_picture(const std::filesystem::path& file) { return read_file(file, read_color); }

IdImage read_signature(const std::filesystem::path& file) { return read_file(file, read_ids); }

}  // namespace alhazen
