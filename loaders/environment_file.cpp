#include "loaders/environment_file.h"

#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "loaders/image_library.h"

namespace alhazen {
namespace {

constexpr int kLargestWidth = 32768;

LoadError error(const std::filesystem::path& file, const std::string& reason) {
  return LoadError(file.string(), "", reason);
}

std::unique_ptr<ImageReader> open(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) throw error(file, "there is no such file");
  const ImageLibrary& library = image_library();
  try {
    return library.open_file(file.string());
  } catch (const std::runtime_error& reason) {
    throw error(file, std::string("not an image that can be read: ") + reason.what());
  }
}

ColorImage read_rgb(const std::filesystem::path& file) {
  const auto in = open(file);
  const ImageLayout& layout = in->layout();
  if (layout.width < 1 || layout.height < 1 || layout.channels.empty()) throw error(file, "has no pixels");
  if (layout.width > kLargestWidth || layout.height > kLargestWidth / 2)
    throw error(file, "is larger than 32768 x 16384 pixels; a smaller one lights just as well");
  const int channels = std::min(int(layout.channels.size()), 3);
  ColorImage image{layout.width, layout.height, {"R", "G", "B"}, {}};
  image.pixels.resize(size_t(layout.width) * size_t(layout.height) * 3);
  try {
    in->read(channels, SampleType::float32, image.pixels.data(), 3 * sizeof(float));
  } catch (const std::runtime_error& reason) {
    throw error(file, std::string("cannot be read: ") + reason.what());
  }
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
