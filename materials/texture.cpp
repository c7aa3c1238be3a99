#include "materials/texture.h"

#include <cstddef>

namespace alhazen {
namespace {

struct TexelPair {
  int a, b;  // neighbours
  float t;   // weight of b
};

/// The coordinate brought into [0, 1]. In double, so that neither huge nor tiny coordinates lose their fraction.
double fold(double u, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return u - std::floor(u);
    case Wrap::mirrored_repeat: {
      const double m = u - 2 * std::floor(u / 2);
      return m > 1 ? 2 - m : m;
    }
    case Wrap::clamp_to_edge:
      return std::clamp(u, 0.0, 1.0);
  }
  return 0;
}

TexelPair neighbours(double u, Wrap wrap, int size, bool nearest) {
  const double x = fold(u, wrap) * size;
  if (nearest) {
    const int i = std::min(int(x), size - 1);
    return {i, i, 0};
  }
  const double low = std::floor(x - 0.5);
  const int a = int(low), b = a + 1;
  const float t = float(x - 0.5 - low);
  // Half a texel beyond either edge: the opposite edge where the image repeats; else (mirrored as well) the edge again.
  if (wrap == Wrap::repeat) return {a < 0 ? size - 1 : a, b >= size ? 0 : b, t};
  return {std::max(a, 0), std::min(b, size - 1), t};
}

template <class Decode>
std::array<float, 256> table_of(const Decode& decode) {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) table[size_t(i)] = decode(float(i) / 255);
  return table;
}

const std::array<std::array<float, 256>, 2> kBytes = {table_of([](float x) { return x; }),  // by ColorSpace
                                                      table_of(linear_from_srgb)};

float decode(uint8_t v, ColorSpace space) { return kBytes[size_t(space)][v]; }
float decode(uint16_t v, ColorSpace space) {
  const float x = float(v) / 65535;
  return space == ColorSpace::srgb ? linear_from_srgb(x) : x;
}
float decode(float v, ColorSpace space) { return space == ColorSpace::srgb ? linear_from_srgb(v) : v; }

template <class T>
Rgba texel(const T* p, int channels, ColorSpace space) {
  const float r = decode(p[0], space);
  switch (channels) {
    case 1:
      return {Rgb{r}, 1};
    case 2:
      return {Rgb{r}, decode(p[1], ColorSpace::linear)};
    case 3:
      return {{r, decode(p[1], space), decode(p[2], space)}, 1};
    default:
      return {{r, decode(p[1], space), decode(p[2], space)}, decode(p[3], ColorSpace::linear)};
  }
}

Rgba mix(const Rgba& a, const Rgba& b, float t) { return {lerp(a.rgb, b.rgb, t), a.a * (1 - t) + b.a * t}; }

template <class T>
Rgba filter(const TextureImage& image, const std::vector<T>& samples, const TexelPair& x, const TexelPair& y,
            ColorSpace space, bool nearest) {
  const auto at = [&](int i, int j) {
    return texel(samples.data() + (size_t(j) * size_t(image.width) + size_t(i)) * size_t(image.channels),
                 image.channels, space);
  };
  if (nearest) return at(x.a, y.a);
  return mix(mix(at(x.a, y.a), at(x.b, y.a), x.t), mix(at(x.a, y.b), at(x.b, y.b), x.t), y.t);
}

Rgba at_level(const TextureImage& image, const Texture& texture, ColorSpace space, double u, double v, bool nearest) {
  const TexelPair x = neighbours(u, texture.wrap_u, image.width, nearest);
  const TexelPair y = neighbours(v, texture.wrap_v, image.height, nearest);
  return std::visit([&](const auto& samples) { return filter(image, samples, x, y, space, nearest); }, image.samples);
}

/// The mip level at which a texel is as large as the footprint; 0 or less where a texel is larger.
float level_of(const TextureImage& image, const TextureUse& use, const SurfaceInputs& inputs) {
  if (!(inputs.footprint > 0) || !inputs.uv_per_metre || int64_t{use.uv_set} >= inputs.uv_count) return 0;
  const float scale = std::sqrt(std::abs(use.xx * use.yy - use.xy * use.yx) * float(image.width) * float(image.height));
  const float texels = inputs.footprint * inputs.uv_per_metre[use.uv_set] * scale;
  return texels > 1 ? std::log2(std::min(texels, 1e9f)) : 0;
}

}  // namespace

Rgba sample_used(const TextureTable& table, const TextureUse& use, ColorSpace space,
                 const SurfaceInputs& inputs) noexcept {
  const Rgba white{Rgb{1.0f}, 1.0f};
  if (!table.textures || !table.images || use.texture >= table.textures->size()) return white;
  const Texture& texture = (*table.textures)[use.texture];
  if (texture.image >= table.images->size()) return white;
  const TextureImage& image = (*table.images)[texture.image];
  if (image.width <= 0 || image.height <= 0 || image.channels < 1 || image.channels > 4) return white;

  double u = 0, v = 0;
  if (inputs.uvs && int64_t{use.uv_set} < inputs.uv_count) {
    const Vec2f uv = inputs.uvs[use.uv_set];
    if (std::isfinite(uv.x) && std::isfinite(uv.y)) u = double(uv.x), v = double(uv.y);
  }
  double tu = double(use.xx) * u + double(use.xy) * v + double(use.x0);
  double tv = double(use.yx) * u + double(use.yy) * v + double(use.y0);
  if (!std::isfinite(tu) || !std::isfinite(tv)) tu = tv = 0;

  const auto look_up = [&](size_t level, bool nearest) {
    return at_level(level == 0 ? image : image.smaller[level - 1], texture, space, tu, tv, nearest);
  };
  const float level = texture.mipmaps == Mipmaps::none ? 0 : level_of(image, use, inputs);
  if (!(level > 0) || image.smaller.empty()) return look_up(0, texture.nearest);
  const float last = float(image.smaller.size());
  if (texture.mipmaps == Mipmaps::nearest)
    return look_up(size_t(std::min(std::round(level), last)), texture.nearest_small);
  const auto below = size_t(std::min(level, last));
  if (float(below) >= last) return look_up(image.smaller.size(), texture.nearest_small);
  return mix(look_up(below, texture.nearest_small), look_up(below + 1, texture.nearest_small), level - float(below));
}

float linear_from_srgb(float encoded) noexcept {
  if (encoded == 1) return 1;
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgb_from_linear(float linear) noexcept {
  if (linear == 1) return 1;
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

}  // namespace alhazen
