#include "loaders/image_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "core/fork_join.h"

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
    } catch (const std::bad_alloc&) {
      failed("out of memory");
    } catch (const std::exception& error) {
      failed(error.what());
    } catch (...) {
      failed("unknown error");
    }
  }));
  return images;
}

}  // namespace alhazen
