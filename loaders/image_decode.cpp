#include "loaders/image_decode.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "loaders/image_header.h"
#include "loaders/image_ktx.h"
#include "loaders/image_library.h"
#include "loaders/in_parallel.h"
#include "materials/mipmap.h"
#include "materials/texel_records.h"

namespace alhazen {
namespace {

/// `texels`: for how many there will be room.
template <class T>
void read_samples(ImageReader& in, SampleType type, size_t texels, TextureImage& image) {
  std::vector<T> samples;
  samples.reserve(texels * size_t(image.channels));
  samples.resize(size_t(image.width) * size_t(image.height) * size_t(image.channels));
  in.read(image.channels, type, samples.data(), ptrdiff_t(size_t(image.channels) * sizeof(T)));
  image.samples = std::move(samples);
}

/// Whether the decoded image, with smaller levels if it is to have them, is within the limits.
void check_size(const EncodedImage& image, const ImageHeader& header, LoadBudget& budget) {
  const uint64_t most = budget.limits().image_pixels;
  if (header.pixels() > most)
    throw LoadError(image.place, "",
                    "its image has " + std::to_string(header.width) + " x " + std::to_string(header.height) +
                        " pixels, expected " + std::to_string(most) + " at most; --max-image-pixels raises the limit");
  const uint64_t bytes = header.pixels() * header.bytes_per_pixel;
  budget.take(image.place, bytes + (image.mipmaps ? bytes / 3 : 0) + header.scratch);
}

TextureImage decode(ImageKind kind, const std::vector<uint8_t>& bytes, const ImageHeader& header, bool mipmaps) {
  if (kind == ImageKind::ktx2) return decode_ktx(bytes);
  const auto in = image_library().open_memory(std::string(name_of(kind)), bytes);
  const ImageLayout& layout = in->layout();
  if (layout.width <= 0 || layout.height <= 0 || layout.channels.empty()) throw std::runtime_error("no pixels");
  if (uint64_t(layout.width) * uint64_t(layout.height) > header.pixels() || layout.depth > 1)
    throw std::runtime_error("cubes and volumes are not read");

  TextureImage image;
  image.width = layout.width, image.height = layout.height, image.channels = std::min(int(layout.channels.size()), 4);
  const size_t texels = mipmaps ? texels_of_levels(image.width, image.height) : 0;
  if (layout.type == SampleType::uint8)
    read_samples<uint8_t>(*in, SampleType::uint8, texels, image);
  else if (layout.type == SampleType::uint16)
    read_samples<uint16_t>(*in, SampleType::uint16, texels, image);
  else
    read_samples<float>(*in, SampleType::float32, texels, image);
  return image;
}

/// One channel, as many bits as the glossiness has.
TextureImage roughness_image(const TextureImage& glossiness, float factor) {
  TextureImage image{glossiness.width, glossiness.height, 1, {}};
  const auto n = size_t(glossiness.channels);
  std::visit(
      [&](const auto& in) {
        using T = typename std::decay_t<decltype(in)>::value_type;
        constexpr float most = std::is_floating_point_v<T> ? 1.0f : float(std::numeric_limits<T>::max());
        std::vector<T> out(size_t(image.width) * size_t(image.height));
        for (size_t i = 0; i < out.size(); ++i) {
          const float alpha = n % 2 == 0 ? float(in[i * n + n - 1]) : most;
          const float roughness = most - factor * alpha;
          out[i] = std::is_floating_point_v<T> ? T(roughness) : T(std::lround(roughness));
        }
        image.samples = std::move(out);
      },
      glossiness.samples);
  return image;
}

}  // namespace

std::vector<TextureImage> decode_images(std::vector<EncodedImage> encoded, const WarningSink& warn,
                                        LoadBudget& budget) {
  std::vector<TextureImage> images(encoded.size());
  std::mutex warning;
  budget.progress.begin("images", encoded.size());
  for_each_in_parallel(encoded.size(), [&](size_t i) {
    ++budget.progress.done;
    if (encoded[i].bytes.empty()) return;
    const auto failed = [&](const std::string& reason) {
      const std::lock_guard lock(warning);
      if (warn) warn(encoded[i].place + ": cannot decode the image, white is used: " + reason);
    };
    try {
      const auto kind = image_kind(encoded[i].bytes);
      if (!kind) return failed("unknown image format");
      const auto header = read_image_header(*kind, encoded[i].bytes);
      if (!header) return failed("its header is damaged, or of a kind that is not read");
      check_size(encoded[i], *header, budget);
      images[i] = decode(*kind, encoded[i].bytes, *header, encoded[i].mipmaps);
      encoded[i].bytes = {};
      if (encoded[i].mipmaps) add_smaller_levels(images[i], encoded[i].space);
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      failed("out of memory");
    } catch (const std::exception& error) {
      failed(error.what());
    } catch (...) {
      failed("unknown error");
    }
  });
  for (size_t i = 0; i < encoded.size(); ++i)
    if (const uint32_t from = encoded[i].glossiness_of; from != kNone && images[from].width > 0) {
      budget.take(encoded[from].place, uint64_t(images[from].width) * uint64_t(images[from].height) * 4 / 3 * 4);
      images[i] = roughness_image(images[from], encoded[i].glossiness_factor);
      if (encoded[i].mipmaps) add_smaller_levels(images[i], ColorSpace::linear);
    }
  return images;
}

std::vector<TextureImage> decode_images(std::vector<EncodedImage> encoded, const WarningSink& warn) {
  LoadBudget budget;
  return decode_images(std::move(encoded), warn, budget);
}

void decode_textures(LoadedScene& loaded, const WarningSink& warn) {
  Scene& scene = loaded.scene;
  std::vector<TextureImage> images = decode_images(std::move(loaded.encoded), warn, *loaded.budget);
  try {
    lay_side_by_side(scene.materials, scene.textures, images, loaded.budget->left());
  } catch (const std::bad_alloc&) {  // they are looked up where they are
  }
  scene.images = std::move(images);
}

}  // namespace alhazen
