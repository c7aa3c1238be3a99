#include "loaders/environment_file.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace alhazen {
namespace {

constexpr int kLargestWidth = 32768;

ColorImage read_rgb(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& reason) -> LoadError { return LoadError(file.string(), "", reason); };
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) throw fail("there is no such file");
  const auto in = OIIO::ImageInput::open(file.string());
  if (!in) throw fail("not an image that can be read: " + OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) throw fail("has no pixels");
  if (spec.width > kLargestWidth || spec.height > kLargestWidth / 2)
    throw fail("is larger than 32768 x 16384 pixels; a smaller one lights just as well");
  const int channels = std::min(spec.nchannels, 3);
  ColorImage image{spec.width, spec.height, {"R", "G", "B"}, {}};
  image.pixels.resize(size_t(spec.width) * size_t(spec.height) * 3);
  constexpr OIIO::stride_t kPixel = 3 * sizeof(float);
  if (!in->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, image.pixels.data(), kPixel))
    throw fail("cannot be read: " + in->geterror());
  if (channels < 3)  // grey
    for (size_t i = 0; i < image.pixels.size(); i += 3) image.pixels[i + 1] = image.pixels[i + 2] = image.pixels[i];
  return image;
}

}  // namespace

Environment load_environment(const std::filesystem::path& file) {
  ColorImage image = read_rgb(file);
  for (float& value : image.pixels)
    if (!(value > 0) || !std::isfinite(value)) value = 0;
  return make_environment(std::move(image));
}

}  // namespace alhazen
