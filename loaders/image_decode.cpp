#include "loaders/image_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/fork_join.h"
#include "loaders/image_ktx.h"
#include "materials/mipmap.h"

namespace alhazen {
namespace {

/// OpenImageIO's name of the format by the file's first bytes; empty: none that is read here.
std::string format_of(const std::vector<uint8_t>& bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<size_t>(bytes.size(), 16));
  if (head.starts_with("\x89PNG")) return "png";
  if (head.starts_with("\xff\xd8\xff")) return "jpeg";
  if (head.starts_with("RIFF") && head.size() >= 12 && head.substr(8, 4) == "WEBP") return "webp";
  if (head.starts_with("\x76\x2f\x31\x01")) return "openexr";
  if (head.starts_with("#?")) return "hdr";
  if (head.starts_with("BM")) return "bmp";
  if (head.starts_with("DDS ")) return "dds";
  return {};
}

template <class T>
void read_samples(OIIO::ImageInput& in, OIIO::TypeDesc type, TextureImage& image) {
  std::vector<T> samples(size_t(image.width) * size_t(image.height) * size_t(image.channels));
  if (!in.read_image(0, 0, 0, image.channels, type, samples.data())) throw std::runtime_error(in.geterror());
  image.samples = std::move(samples);
}

TextureImage decode(const std::vector<uint8_t>& bytes) {
  const std::string format = format_of(bytes);
  if (is_ktx(bytes)) return decode_ktx(bytes);
  if (format.empty()) throw std::runtime_error("unknown image format");
  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const auto in = OIIO::ImageInput::create(format);
  if (!in) throw std::runtime_error(OIIO::geterror());
  if (!in->supports("ioproxy") || !in->set_ioproxy(&reader))
    throw std::runtime_error(format + " images cannot be read from memory");
  OIIO::ImageSpec config, spec;
  config["oiio:UnassociatedAlpha"] = 1;
  if (!in->open("image." + format, spec, config)) throw std::runtime_error(in->geterror());
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) throw std::runtime_error("no pixels");

  TextureImage image;
  image.width = spec.width, image.height = spec.height, image.channels = std::min(spec.nchannels, 4);
  if (spec.format == OIIO::TypeDesc::UINT8)
    read_samples<uint8_t>(*in, OIIO::TypeDesc::UINT8, image);
  else if (spec.format == OIIO::TypeDesc::UINT16)
    read_samples<uint16_t>(*in, OIIO::TypeDesc::UINT16, image);
  else
    read_samples<float>(*in, OIIO::TypeDesc::FLOAT, image);
  in->close();
  return image;
}

/// One channel, as many bits as the glossiness has.
TextureImage roughness_image(const TextureImage& glossiness, float factor) {
  TextureImage image{glossiness.width, glossiness.height, 1, {}, {}};
  const auto n = size_t(glossiness.channels);
  std::visit(
      [&](const auto& in) {
        using T = typename std::decay_t<decltype(in)>::value_type;
        constexpr float most = std::is_floating_point_v<T> ? 1.0f : float(std::numeric_limits<T>::max());
        std::vector<T> out(in.size() / n);
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

std::vector<TextureImage> decode_images(const std::vector<EncodedImage>& encoded, const WarningSink& warn) {
  std::vector<TextureImage> images(encoded.size());
  std::mutex warning;
  const ForkJoin order;
  tbb::parallel_for(size_t(0), encoded.size(), order.task([&](size_t i) {
    if (encoded[i].bytes.empty()) return;
    const auto failed = [&](const std::string& reason) {
      const std::lock_guard lock(warning);
      if (warn) warn(encoded[i].place + ": cannot decode the image, white is used: " + reason);
    };
    try {
      images[i] = decode(encoded[i].bytes);
      if (encoded[i].mipmaps) add_smaller_levels(images[i], encoded[i].space);
    } catch (const std::bad_alloc&) {
      failed("out of memory");
    } catch (const std::exception& error) {
      failed(error.what());
    } catch (...) {
      failed("unknown error");
    }
  }));
  for (size_t i = 0; i < encoded.size(); ++i)
    if (const uint32_t from = encoded[i].glossiness_of; from != kNone && images[from].width > 0) {
      images[i] = roughness_image(images[from], encoded[i].glossiness_factor);
      if (encoded[i].mipmaps) add_smaller_levels(images[i], ColorSpace::linear);
    }
  return images;
}

}  // namespace alhazen
