#include "inspect/layer_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "inspect/legend.h"
#include "inspect/signature.h"
#include "inspect/tree_words.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

constexpr double kShownShare = 0.999;  // of the pixels: a few extremes would leave no colours for the others
constexpr int kScaleRows = 9;

Rgb from_srgb(const Rgb& c) { return {linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)}; }

/// f(pixel) for each.
template <class F>
ColorImage picture_of(int width, int height, const F& f) {
  ColorImage picture{width, height, {"R", "G", "B", "A"}, {}};
  picture.pixels.resize(size_t(width) * size_t(height) * 4);
  for (size_t i = 0; i < picture.pixels.size() / 4; ++i) {
    const Rgb c = f(i);
    float* out = &picture.pixels[4 * i];
    out[0] = c.r, out[1] = c.g, out[2] = c.b, out[3] = 1;
  }
  return picture;
}

struct Range {
  float least = 0, most = 1;
  [[nodiscard]] float share(float v) const { return std::clamp((v - least) / (most - least), 0.0f, 1.0f); }
};

/// Of every n-th value from `first` on, what is not finite and the extremes left out.
Range range_of(const std::vector<float>& values, size_t first, size_t n) {
  std::vector<float> finite;
  for (size_t i = first; i < values.size(); i += n)
    if (std::isfinite(values[i])) finite.push_back(values[i]);
  if (finite.empty()) return {};
  std::ranges::sort(finite);
  const Range range{finite.front(), finite[size_t(kShownShare * double(finite.size() - 1))]};
  return range.most > range.least ? range : Range{range.least, range.least + 1};
}

ColorImage heat_picture(const LayerImage& layer, int width, int height) {
  const Range range = range_of(layer.floats, 0, 1);
  const ColorImage picture = picture_of(width, height, [&](size_t i) {
    return std::isfinite(layer.floats[i]) ? heat_color(range.share(layer.floats[i])) : Rgb(0.0f);
  });
  std::vector<LegendRow> rows;
  for (int k = kScaleRows - 1; k >= 0; --k) {
    const float t = float(k) / (kScaleRows - 1);
    const bool top = k == kScaleRows - 1;
    rows.push_back({heat_color(t),
                    short_number(double(range.least + t * (range.most - range.least))) + (top ? " and more" : ""),
                    top ? layer.name : ""});
  }
  return with_legend(picture, rows);
}

ColorImage id_picture(const LayerImage& layer, int width, int height) {
  return picture_of(width, height, [&](size_t i) { return linear_node_color(layer.ids[i]); });
}

ColorImage range_picture(const LayerImage& layer, int width, int height) {
  const size_t n = layer.channels.size();
  std::array<Range, 3> ranges;
  for (size_t c = 0; c < n; ++c) ranges[c] = range_of(layer.floats, c, n);
  return picture_of(width, height, [&](size_t i) {
    const auto value = [&](size_t c) { return c < n ? ranges[c].share(layer.floats[n * i + c]) : 0.0f; };
    return from_srgb({value(0), value(1), value(2)});
  });
}

}  // namespace

Rgb heat_color(float t) noexcept {
  constexpr std::array<Rgb, 7> kViridis{
      Rgb{0.2777273272f, 0.0054073445f, 0.3340998053f},   Rgb{0.1050930431f, 1.4046135299f, 1.3845901626f},
      Rgb{-0.3308618287f, 0.2148475595f, 0.0950951630f},  Rgb{-4.6342304988f, -5.7991009734f, -19.3324409563f},
      Rgb{6.2282699363f, 14.1799333668f, 56.6905526007f}, Rgb{4.7763849978f, -13.7451453777f, -65.3530326334f},
      Rgb{-5.4354558559f, 4.6458526122f, 26.3124352496f}};
  Rgb sum;
  for (size_t k = kViridis.size(); k-- > 0;) sum = kViridis[k] + sum * std::clamp(t, 0.0f, 1.0f);
  return from_srgb({std::clamp(sum.r, 0.0f, 1.0f), std::clamp(sum.g, 0.0f, 1.0f), std::clamp(sum.b, 0.0f, 1.0f)});
}

ColorImage layer_picture(const LayerImage& layer, int width, int height) {
  if (layer.floats.empty()) return id_picture(layer, width, height);
  if (layer.channels.size() == 1) return heat_picture(layer, width, height);
  const std::vector<float>& v = layer.floats;
  if (layer.channels[0] == "R")
    return picture_of(width, height, [&](size_t i) { return Rgb{v[3 * i], v[3 * i + 1], v[3 * i + 2]}; });
  if (layer.name.ends_with("normal"))
    return picture_of(width, height, [&](size_t i) {
      return from_srgb({0.5f + 0.5f * v[3 * i], 0.5f + 0.5f * v[3 * i + 1], 0.5f + 0.5f * v[3 * i + 2]});
    });
  return range_picture(layer, width, height);
}

}  // namespace alhazen
