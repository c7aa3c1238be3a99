#include "inspect/matte_picture.h"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "inspect/labels.h"
#include "inspect/legend.h"
#include "inspect/signature.h"

namespace alhazen {
namespace {

struct Matte {
  Rgb color;  // linear
  std::string name;
  double pixels = 0;
};

/// By the bits of their ids.
std::unordered_map<uint32_t, Matte> named_mattes(const LayerImage& image) {
  std::unordered_map<uint32_t, Matte> mattes;
  for (const auto& [key, value] : image.attributes) {
    if (!key.ends_with("/manifest")) continue;
    const auto manifest = nlohmann::json::parse(value);
    for (const auto& [name, id] : manifest.items())
      mattes.try_emplace(uint32_t(std::stoul(id.get<std::string>(), nullptr, 16)),
                         Matte{linear_node_color(uint32_t(mattes.size())), name});
  }
  return mattes;
}

std::vector<LegendRow> legend_rows(const std::unordered_map<uint32_t, Matte>& mattes, double pixels) {
  std::vector<Matte> seen;
  for (const auto& [id, matte] : mattes)
    if (matte.pixels > 0) seen.push_back(matte);
  std::ranges::sort(seen, [](const Matte& a, const Matte& b) {
    return a.pixels != b.pixels ? a.pixels > b.pixels : a.name < b.name;
  });
  std::vector<LegendRow> rows;
  for (const Matte& matte : seen) rows.push_back({matte.color, matte.name, share_text(matte.pixels / pixels)});
  return rows;
}

}  // namespace

ColorImage matte_picture(std::span<const LayerImage> images, int width, int height) {
  const size_t pixels = size_t(width) * size_t(height);
  auto mattes = named_mattes(images[0]);
  ColorImage picture{width, height, {"R", "G", "B", "A"}, {}};
  picture.pixels.resize(4 * pixels);
  for (size_t i = 0; i < pixels; ++i) {
    Rgb color;
    for (const LayerImage& image : images)
      for (size_t rank = 0; rank < 2; ++rank) {
        const float id = image.floats[4 * i + 2 * rank], coverage = image.floats[4 * i + 2 * rank + 1];
        if (!(coverage > 0)) continue;
        Matte& matte = mattes.at(std::bit_cast<uint32_t>(id));
        color += matte.color * coverage, matte.pixels += double(coverage);
      }
    float* out = &picture.pixels[4 * i];
    out[0] = color.r, out[1] = color.g, out[2] = color.b, out[3] = 1;
  }
  return with_legend(picture, legend_rows(mattes, double(pixels)));
}

}  // namespace alhazen
