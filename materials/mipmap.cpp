#include "materials/mipmap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

namespace alhazen {
namespace {

constexpr size_t kEncodeSteps = 1 << 14;

/// Eight bits as linear light, and back to within one step.
struct SrgbTables {
  std::array<float, 256> linear{};
  std::array<uint8_t, kEncodeSteps + 1> encoded{};

  SrgbTables() {
    for (size_t i = 0; i < linear.size(); ++i) linear[i] = linear_from_srgb(float(i) / 255);
    for (size_t i = 0; i < encoded.size(); ++i)
      encoded[i] = uint8_t(std::lround(255 * srgb_from_linear(float(i) / kEncodeSteps)));
  }
};

const SrgbTables& srgb_tables() {
  static const SrgbTables tables;
  return tables;
}

template <class T>
T mean(T a, T b, T c, T d) {
  if constexpr (std::is_floating_point_v<T>)
    return (a + b + c + d) / 4;
  else
    return T((uint32_t(a) + b + c + d + 2) / 4);
}

template <class T>
T mean_of_srgb(T a, T b, T c, T d) {
  if constexpr (std::is_same_v<T, uint8_t>) {
    const SrgbTables& t = srgb_tables();
    const float linear = (t.linear[a] + t.linear[b] + t.linear[c] + t.linear[d]) / 4;
    return t.encoded[size_t(linear * kEncodeSteps + 0.5f)];
  } else {
    constexpr float most = std::is_floating_point_v<T> ? 1.0f : float(std::numeric_limits<T>::max());
    const auto linear = [](T v) { return linear_from_srgb(float(v) / most); };
    const float encoded = srgb_from_linear((linear(a) + linear(b) + linear(c) + linear(d)) / 4) * most;
    return std::is_floating_point_v<T> ? T(encoded) : T(std::lround(encoded));
  }
}

template <class T>
TextureImage halved(const TextureImage& image, const std::vector<T>& in, ColorSpace space) {
  TextureImage half{std::max(1, image.width / 2), std::max(1, image.height / 2), image.channels, {}, {}};
  const auto channels = size_t(image.channels), colors = channels < 3 ? size_t{1} : size_t{3};
  std::vector<T> out(size_t(half.width) * size_t(half.height) * channels);
  T* to = out.data();
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      const auto at = [&](int i, int k) {
        const int column = std::min(2 * x + i, image.width - 1), row = std::min(2 * y + k, image.height - 1);
        return in.data() + (size_t(row) * size_t(image.width) + size_t(column)) * channels;
      };
      const T *a = at(0, 0), *b = at(1, 0), *c = at(0, 1), *d = at(1, 1);
      for (size_t k = 0; k < channels; ++k)
        *to++ = space == ColorSpace::srgb && k < colors ? mean_of_srgb(a[k], b[k], c[k], d[k])
                                                        : mean(a[k], b[k], c[k], d[k]);
    }
  half.samples = std::move(out);
  return half;
}

}  // namespace

void add_smaller_levels(TextureImage& image, ColorSpace space) {
  image.smaller.clear();
  if (image.width <= 0 || image.height <= 0) return;
  const TextureImage* last = &image;
  while (last->width > 1 || last->height > 1) {
    TextureImage half = std::visit([&](const auto& samples) { return halved(*last, samples, space); }, last->samples);
    image.smaller.push_back(std::move(half));
    last = &image.smaller.back();
  }
}

}  // namespace alhazen
