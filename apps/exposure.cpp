#include "apps/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace alhazen {
namespace {

constexpr float kWhite = 1 + 1.0f / 512;  // the first value that 8 bits show darker than it is
constexpr float kStep = 0.5f;             // stops that people choose between

}  // namespace

void expose(ColorImage& image, float stops) {
  if (stops == 0) return;
  const float factor = std::exp2(stops);
  for (size_t i = 0; i < image.pixels.size(); i += 4)
    for (size_t c = 0; c < 3; ++c) image.pixels[i + c] *= factor;
}

Clipping clipping(const ColorImage& image) {
  std::vector<float> darkest;  // channel of each pixel
  darkest.reserve(image.pixels.size() / 4);
  for (size_t i = 0; i + 3 < image.pixels.size(); i += 4) {
    const float* p = &image.pixels[i];
    darkest.push_back(std::min({p[0], p[1], p[2]}) / (p[3] > 0 ? p[3] : 1.0f));
  }
  const auto white = std::count_if(darkest.begin(), darkest.end(), [](float v) { return v > kWhite; });
  if (white == 0) return {};
  const auto bright = darkest.begin() + ptrdiff_t(double(darkest.size() - 1) * 0.99);
  std::nth_element(darkest.begin(), bright, darkest.end());
  const float stops = -kStep * std::ceil(std::log2(std::max(1.0f, *bright)) / kStep);
  return {double(white) / double(darkest.size()), stops};
}

}  // namespace alhazen
