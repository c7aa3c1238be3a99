// A picture with its layers to one OpenEXR file.
#pragma once

#include <filesystem>
#include <vector>

#include "core/image.h"
#include "loaders/image_file.h"
#include "renderer/layer.h"

namespace alhazen {

/// Writes R, G, B, A and a channel for each of a layer's, named LAYER.CHANNEL; with `multipart` a part for each layer,
/// named after it, the picture's first. Ids are 32-bit integers; of floats only colours become half where `encoding`
/// says so, and what must arrive to the bit is compressed by zip whatever it says. Written completely or not at all.
/// Throws WriteError.
void write_layers(const std::filesystem::path& file, const ColorImage& color, const std::vector<LayerImage>& layers,
                  bool multipart, const ImageEncoding& encoding, const Metadata& metadata);

}  // namespace alhazen
