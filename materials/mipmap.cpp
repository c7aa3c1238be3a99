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

/// The texels of the next level behind those of `level`.
template <class T>
void halve(const MipLevel& level, size_t channels, ColorSpace space, std::vector<T>& samples) {
  const MipLevel half = level.next();
  const size_t colors = channels < 3 ? 1 : 3;
  const T* const in = samples.data() + level.first_texel * channels;
  T* to = samples.data() + half.first_texel * channels;
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      const auto at = [&](int i, int k) {
        const int column = std::min(2 * x + i, level.width - 1), row = std::min(2 * y + k, level.height - 1);
        return in + (size_t(row) * size_t(level.width) + size_t(column)) * channels;
      };
      const T *a = at(0, 0), *b = at(1, 0), *c = at(0, 1), *d = at(1, 1);
      for (size_t k = 0; k < channels; ++k)
        *to++ = space == ColorSpace::srgb && k < colors ? mean_of_srgb(a[k], b[k], c[k], d[k])
                                                        : mean(a[k], b[k], c[k], d[k]);
    }
}

}  // namespace

size_t texels_of_levels(int width, int height) {
  MipLevel level{width, height};
  while (level.width > 1 || level.height > 1) level = level.next();
  return level.first_texel + 1;
}

void add_smaller_levels(TextureImage& image, ColorSpace space) {
  if (image.width <= 0 || image.height <= 0) return;
  const auto channels = size_t(image.channels);
  std::visit(
      [&](auto& samples) {
        samples.resize(texels_of_levels(image.width, image.height) * channels);
        for (MipLevel level{image.width, image.height}; level.width > 1 || level.height > 1; level = level.next()) {
          halve(level, channels, space, samples);
          ++image.levels;
        }
      },
      image.samples);
}

}  // namespace alhazen
