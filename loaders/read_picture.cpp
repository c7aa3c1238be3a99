#include "loaders/read_picture.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>

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

}  // namespace alhazen
