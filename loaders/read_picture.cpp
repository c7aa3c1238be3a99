#include "loaders/read_picture.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "materials/texture.h"

namespace alhazen {

ColorImage read_picture(const std::filesystem::path& file) {
  const auto in = OIIO::ImageInput::open(file.string());
  if (!in) throw LoadError(file.string(), "", OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  if (spec.nchannels < 3) throw LoadError(file.string(), "", "is no colour picture");
  ColorImage image{spec.width, spec.height, {"R", "G", "B"}, {}};
  image.pixels.resize(size_t(spec.width) * size_t(spec.height) * 3);
  if (!in->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, image.pixels.data()))
    throw LoadError(file.string(), "", in->geterror());
  if (spec.format == OIIO::TypeDesc::UINT8)
    std::ranges::transform(image.pixels, image.pixels.begin(), linear_from_srgb);
  return image;
}

IdImage read_signature(const std::filesystem::path& file) {
  const auto in = OIIO::ImageInput::open(file.string());
  if (!in) throw LoadError(file.string(), "", OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  IdImage image{spec.width, spec.height, {"node", "primitive", "material"}, {}};
  std::array<size_t, 3> from;
  for (size_t c = 0; c < 3; ++c) {
    const int index = spec.channelindex(image.channels[c]);
    if (index < 0 || spec.format != OIIO::TypeDesc::UINT32)
      throw LoadError(file.string(), "",
                      "is no scene signature: expected the 32-bit UINT channels node, primitive, material");
    from[c] = size_t(index);
  }
  const size_t pixels = size_t(spec.width) * size_t(spec.height), channels = size_t(spec.nchannels);
  std::vector<uint32_t> stored(pixels * channels);
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT32, stored.data()))
    throw LoadError(file.string(), "", in->geterror());
  image.pixels.resize(3 * pixels);
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = stored[i / 3 * channels + from[i % 3]];
  return image;
}

}  // namespace alhazen
