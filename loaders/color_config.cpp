#include "loaders/color_config.h"

#include "loaders/image_library.h"
#include "materials/texture.h"

namespace alhazen {

DisplayTransform::DisplayTransform(const DisplayView& wanted) : processor_(image_library().display_processor(wanted)) {}

DisplayTransform::~DisplayTransform() = default;

void DisplayTransform::apply(ColorImage& image) const {
  const auto for_each_straight = [&](const auto& change) {
    for (size_t i = 0; i + 3 < image.pixels.size(); i += 4)
      if (image.pixels[i + 3] > 0) change(&image.pixels[i], image.pixels[i + 3]);
  };
  for_each_straight([](float* p, float alpha) {
    for (int k = 0; k < 3; ++k) p[k] /= alpha;
  });
  processor_->apply(image.pixels.data(), image.width, image.height);
  for_each_straight([](float* p, float alpha) {
    for (int k = 0; k < 3; ++k) p[k] = alpha * linear_from_srgb(p[k] > 0 ? std::min(p[k], 1.0f) : 0.0f);
  });
}

}  // namespace alhazen
