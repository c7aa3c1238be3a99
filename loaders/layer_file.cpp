#include "loaders/layer_file.h"

#include <string>

#include "core/error.h"
#include "loaders/openexr_file.h"
#include "loaders/part_file.h"

namespace alhazen {
namespace {

ExrType float_type(bool half) { return half ? ExrType::half : ExrType::float32; }

ExrPart color_part(const ColorImage& color, const ImageEncoding& encoding) {
  ExrPart part{"rgba", {}, encoding.compression, {}};
  for (size_t c = 0; c < 4; ++c)
    part.channels.push_back({color.channels[c], float_type(encoding.half), color.pixels.data() + c, 4});
  return part;
}

/// Whether it takes no compression that loses anything.
bool is_exact(const LayerImage& layer) { return layer.exact || layer.floats.empty(); }

ExrPart layer_part(const LayerImage& layer, const ImageEncoding& encoding) {
  ExrPart part{layer.name, {}, is_exact(layer) ? "zip" : encoding.compression, layer.attributes};
  const bool color = layer.channels[0] == "R" && !layer.exact;
  for (size_t c = 0; c < layer.channels.size(); ++c) {
    const std::string name = layer.name + "." + layer.channels[c];
    if (layer.floats.empty())
      part.channels.push_back({name, ExrType::uint32, layer.ids.data() + c, layer.channels.size()});
    else
      part.channels.push_back(
          {name, float_type(encoding.half && color), layer.floats.data() + c, layer.channels.size()});
  }
  return part;
}

std::vector<ExrPart> parts_of(const ColorImage& color, const std::vector<LayerImage>& layers, bool multipart,
                              const ImageEncoding& encoding, const Metadata& metadata) {
  std::vector<ExrPart> parts{color_part(color, encoding)};
  for (const LayerImage& layer : layers) {
    ExrPart part = layer_part(layer, encoding);
    if (multipart) {
      parts.push_back(std::move(part));
      continue;
    }
    parts[0].channels.insert(parts[0].channels.end(), part.channels.begin(), part.channels.end());
    parts[0].metadata.insert(parts[0].metadata.end(), part.metadata.begin(), part.metadata.end());
    if (is_exact(layer)) parts[0].compression = "zip";
  }
  for (ExrPart& part : parts) part.metadata.insert(part.metadata.begin(), metadata.begin(), metadata.end());
  return parts;
}

}  // namespace

void write_layers(const std::filesystem::path& file, const ColorImage& color, const std::vector<LayerImage>& layers,
                  bool multipart, const ImageEncoding& encoding, const Metadata& metadata) {
  const std::vector<ExrPart> parts = parts_of(color, layers, multipart, encoding, metadata);
  write_whole(file, [&](PartFile& part) { part.write(encoded_exr(color.width, color.height, parts)); });
}

}  // namespace alhazen
