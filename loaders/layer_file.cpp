#include "loaders/layer_file.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "core/error.h"
#include "loaders/part_file.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

constexpr float kLargestHalf = 65504;

/// One channel as it lies in memory.
struct Channel {
  std::string name;
  OIIO::TypeDesc type;  // stored
  const float* floats;  // one of the two
  const uint32_t* ids;
  size_t stride;  // values from pixel to pixel
};

struct Part {
  std::string name;
  std::vector<Channel> channels;
  Metadata attributes{};
  bool exact = false;  // takes no compression that loses anything
};

OIIO::TypeDesc float_type(bool half) { return half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT; }

Part color_part(const ColorImage& color, bool half) {
  Part part{.name = "rgba", .channels = {}};
  for (size_t c = 0; c < 4; ++c)
    part.channels.push_back({color.channels[c], float_type(half), color.pixels.data() + c, nullptr, 4});
  return part;
}

Part layer_part(const LayerImage& layer, bool half) {
  Part part{layer.name, {}, layer.attributes, layer.exact || layer.floats.empty()};
  const bool color = layer.channels[0] == "R" && !layer.exact;
  for (size_t c = 0; c < layer.channels.size(); ++c) {
    const std::string name = layer.name + "." + layer.channels[c];
    if (layer.floats.empty())
      part.channels.push_back({name, OIIO::TypeDesc::UINT32, nullptr, layer.ids.data() + c, layer.channels.size()});
    else
      part.channels.push_back(
          {name, float_type(half && color), layer.floats.data() + c, nullptr, layer.channels.size()});
  }
  return part;
}

OIIO::ImageSpec spec_of(const Part& part, int width, int height, const ImageEncoding& encoding,
                        const Metadata& metadata) {
  OIIO::ImageSpec spec(width, height, int(part.channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const Channel& channel : part.channels)
    spec.channelnames.push_back(channel.name), spec.channelformats.push_back(channel.type);
  spec.alpha_channel = part.channels[0].name == "R" ? 3 : -1, spec.z_channel = -1;
  spec.attribute("oiio:subimagename", part.name);
  spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("compression", encoding.compression.empty() || part.exact ? "zip" : encoding.compression);
  for (const Metadata& attributes : {metadata, part.attributes})
    for (const auto& [name, value] : attributes) spec.attribute(name, value);
  return spec;
}

/// All channels of a pixel side by side, each in its own type: 16 or 32 bits.
std::vector<uint8_t> interleaved(const Part& part, size_t pixels) {
  size_t pixel_bytes = 0;
  for (const Channel& channel : part.channels) pixel_bytes += channel.type.size();
  std::vector<uint8_t> bytes(pixel_bytes * pixels);
  size_t offset = 0;
  for (const Channel& channel : part.channels) {
    for (size_t i = 0; i < pixels; ++i) {
      uint8_t* out = &bytes[i * pixel_bytes + offset];
      if (channel.ids)
        std::memcpy(out, channel.ids + i * channel.stride, sizeof(uint32_t));
      else if (channel.type == OIIO::TypeDesc::FLOAT)
        std::memcpy(out, channel.floats + i * channel.stride, sizeof(float));
      else {
        const float clamped = std::clamp(channel.floats[i * channel.stride], -kLargestHalf, kLargestHalf);
        OIIO::convert_types(OIIO::TypeDesc::FLOAT, &clamped, OIIO::TypeDesc::HALF, out, 1);
      }
    }
    offset += channel.type.size();
  }
  return bytes;
}

std::vector<Part> parts_of(const ColorImage& color, const std::vector<LayerImage>& layers, bool multipart, bool half) {
  std::vector<Part> parts{color_part(color, half)};
  for (const LayerImage& layer : layers) {
    Part part = layer_part(layer, half);
    if (multipart) {
      parts.push_back(std::move(part));
      continue;
    }
    for (Channel& channel : part.channels) parts[0].channels.push_back(std::move(channel));
    parts[0].attributes.insert(parts[0].attributes.end(), part.attributes.begin(), part.attributes.end());
    parts[0].exact |= part.exact;
  }
  return parts;
}

/// Reads the last pixels again: not every failure of the disk is told while writing.
void check_complete(const fs::path& file, const std::string& name, size_t parts) {
  const auto in = OIIO::ImageInput::open(name);
  bool ok = in && in->seek_subimage(int(parts) - 1, 0);
  if (ok) {
    const OIIO::ImageSpec& spec = in->spec();
    std::vector<float> row(size_t(spec.width) * size_t(spec.nchannels));
    ok = in->read_scanline(spec.height - 1, 0, OIIO::TypeDesc::FLOAT, row.data());
  }
  if (!ok) throw WriteError(file.string(), "is not complete: " + (in ? in->geterror() : OIIO::geterror()));
}

}  // namespace

void write_layers(const fs::path& file, const ColorImage& color, const std::vector<LayerImage>& layers, bool multipart,
                  const ImageEncoding& encoding, const Metadata& metadata) {
  PartFile target(file);
  const std::string name = target.path().string();
  const auto out = OIIO::ImageOutput::create(name);
  const auto check = [&](bool ok) {
    if (!ok) throw WriteError(file.string(), out ? out->geterror() : OIIO::geterror());
  };
  check(out != nullptr);
  const std::vector<Part> parts = parts_of(color, layers, multipart, encoding.half);
  std::vector<OIIO::ImageSpec> specs;
  for (const Part& part : parts) specs.push_back(spec_of(part, color.width, color.height, encoding, metadata));
  check(out->open(name, int(specs.size()), specs.data()));
  for (size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) check(out->open(name, specs[i], OIIO::ImageOutput::AppendSubimage));
    const auto pixels = interleaved(parts[i], size_t(color.width) * size_t(color.height));
    check(out->write_image(OIIO::TypeDesc::UNKNOWN, pixels.data()));
  }
  check(out->close());
  check_complete(file, name, parts.size());
  target.commit();
}

}  // namespace alhazen
