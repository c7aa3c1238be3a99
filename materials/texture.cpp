#include "materials/texture.h"

#include <algorithm>
#include <cstddef>

#include "core/lane_memory.h"

namespace alhazen {
namespace {

template <class T>
T rounded_down(const T& x) {
  if constexpr (IsLanes<T>)
    return std::experimental::floor(x);
  else
    return std::floor(x);
}

template <class D>
MaskOf<D> is_finite_number(const D& x) {
  return x - x == D(0);
}

/// The coordinate brought into [0, 1]. In double, so that neither huge nor tiny coordinates lose their fraction.
template <class D>
D fold(const D& u, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return u - rounded_down(u);
    case Wrap::mirrored_repeat: {
      const D m = u - D(2) * rounded_down(D(u / D(2)));
      return select(m > D(1), D(D(2) - m), m);
    }
    case Wrap::clamp_to_edge:
      return select(u < D(0), D(0), select(D(1) < u, D(1), u));
  }
  return D(0);
}

/// Two texels side by side in each lane.
template <class F>
struct TexelPair {
  LaneArray<IntOf<F>> a, b;
  F t;  // weight of b
};

/// `folded`: the coordinate in [0, 1]; `size`: texels along it. Where `nearest`, both are that one.
template <class F>
TexelPair<F> neighbours(const DoubleOf<F>& folded, Wrap wrap, const IntOf<F>& size, const MaskOf<F>& nearest) {
  using D = DoubleOf<F>;
  using I = IntOf<F>;
  const D x = folded * convert<D>(size), low = rounded_down(D(x - D(0.5)));
  const I last = size - I(1), a = convert<I>(low), b = a + I(1), there = smaller(convert<I>(x), last);
  // Half a texel beyond either edge: the opposite edge where the image repeats; else (mirrored as well) the edge again.
  const bool repeats = wrap == Wrap::repeat;
  const I inner_a = select(a < I(0), repeats ? last : I(0), a), inner_b = select(b > last, repeats ? I(0) : last, b);
  const auto only = convert_mask<I>(nearest);
  TexelPair<F> pair;
  pair.a.store(select(only, there, inner_a)), pair.b.store(select(only, there, inner_b));
  pair.t = select(nearest, F(0), convert<F>(D(x - D(0.5) - low)));
  return pair;
}

template <class Decode>
std::array<float, 256> table_of(const Decode& decode) {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) table[size_t(i)] = decode(float(i) / 255);
  return table;
}

const std::array<std::array<float, 256>, 2> kBytes = {table_of([](float x) { return x; }),  // by ColorSpace
                                                      table_of(linear_from_srgb)};

inline float decode(uint8_t v, ColorSpace space) { return kBytes[size_t(space)][v]; }
inline float decode(uint16_t v, ColorSpace space) {
  const float x = float(v) / 65535;
  return space == ColorSpace::srgb ? linear_from_srgb(x) : x;
}
inline float decode(float v, ColorSpace space) { return space == ColorSpace::srgb ? linear_from_srgb(v) : v; }

template <int channels, class T>
Rgba texel(const T* p, ColorSpace space) {
  const float r = decode(p[0], space), a = channels % 2 ? 1 : decode(p[channels - 1], ColorSpace::linear);
  if constexpr (channels < 3)
    return {Rgb{r}, a};
  else
    return {{r, decode(p[1], space), decode(p[2], space)}, a};
}

/// Texels on their way from memory to lanes.
template <class F>
struct RgbaArray {
  RgbArray<F> rgb;
  LaneArray<F> a;

  void set(size_t k, const Rgba& c) { rgb.set(k, c.rgb), a[k] = c.a; }
  [[nodiscard]] BasicRgba<F> load() const { return {rgb.load(), a.load()}; }
};

template <class F>
BasicRgba<F> mix(const BasicRgba<F>& a, const BasicRgba<F>& b, const F& t) {
  return {lerp(a.rgb, b.rgb, t), a.a * (F(1) - t) + b.a * t};
}

/// The image of a mip level in each lane; all are of one chain.
template <class F>
using LevelImages = std::array<const TextureImage*, kWidthOf<F>>;

/// Texels of any kind, lane by lane.
template <int channels, class T, class F>
struct TexelsOneByOne {
  const LevelImages<F>& images;
  ColorSpace space;

  BasicRgba<F> operator()(const LaneArray<IntOf<F>>& x, const LaneArray<IntOf<F>>& y) const {
    RgbaArray<F> texels;
    for (size_t k = 0; k < kWidthOf<F>; ++k) {
      const T* samples = std::get_if<std::vector<T>>(&images[k]->samples)->data();
      const size_t texel_number = size_t(y[k]) * size_t(images[k]->width) + size_t(x[k]);
      texels.set(k, texel<channels>(samples + texel_number * channels, space));
    }
    return texels.load();
  }
};

/// byte / 255 as the division rounds it: 0x1.01p-8 times a byte has no rounding.
template <class F>
F linear_byte(const F& byte) {
  return byte * F(0x1.01p-8f) + byte * F(0x1.010102p-24f);
}

/// Texels of bytes, in all lanes at once: four bytes are fetched, of which the first are the channels.
template <int channels, class F>
struct TexelsOfBytes {
  using I = IntOf<F>;
  AddressOf<F> samples;
  I width, last_word;  // where the image's last four bytes begin
  ColorSpace space;

  BasicRgba<F> operator()(const LaneArray<I>& x, const LaneArray<I>& y) const {
    const I offset = (y.load() * width + x.load()) * I(channels), at = smaller(offset, last_word);
    const I word = load_at<I>(samples + convert<AddressOf<F>>(at)) >> ((offset - at) * I(8));
    const auto channel = [&](int c, ColorSpace of_channel) {
      const I byte = (word >> (8 * c)) & I(0xFF);
      return of_channel == ColorSpace::srgb ? gather<F>(kBytes[size_t(ColorSpace::srgb)].data(), byte)
                                            : linear_byte<F>(convert<F>(byte));
    };
    const F r = channel(0, space), a = channels % 2 ? F(1) : channel(channels - 1, ColorSpace::linear);
    if constexpr (channels < 3)
      return {BasicRgb<F>(r), a};
    else
      return {{r, channel(1, space), channel(2, space)}, a};
  }
};

template <class F, class Texels>
BasicRgba<F> filtered(const Texels& texels, const TexelPair<F>& x, const TexelPair<F>& y) {
  return mix(mix(texels(x.a, y.a), texels(x.b, y.a), x.t), mix(texels(x.a, y.b), texels(x.b, y.b), x.t), y.t);
}

template <int channels, class F>
BasicRgba<F> filtered(const LevelImages<F>& images, ColorSpace space, const IntOf<F>& width, const TexelPair<F>& x,
                      const TexelPair<F>& y) {
  const TextureImage& image = *images[0];
  if (std::holds_alternative<std::vector<uint16_t>>(image.samples))
    return filtered(TexelsOneByOne<channels, uint16_t, F>{images, space}, x, y);
  if (std::holds_alternative<std::vector<float>>(image.samples))
    return filtered(TexelsOneByOne<channels, float, F>{images, space}, x, y);
  if constexpr (IsLanes<F>) {
    LaneArray<AddressOf<F>> samples;
    LaneArray<IntOf<F>> last_word;
    bool fits = true;
    for (size_t k = 0; k < kWidthOf<F>; ++k) {
      const auto& bytes = *std::get_if<std::vector<uint8_t>>(&images[k]->samples);
      fits = fits && bytes.size() >= 4 && bytes.size() <= size_t(std::numeric_limits<int32_t>::max());
      samples[k] = reinterpret_cast<uintptr_t>(bytes.data()), last_word[k] = int32_t(bytes.size()) - 4;
    }
    if (fits) return filtered(TexelsOfBytes<channels, F>{samples.load(), width, last_word.load(), space}, x, y);
  }
  return filtered(TexelsOneByOne<channels, uint8_t, F>{images, space}, x, y);
}

template <class F>
BasicRgba<F> at_levels(const LevelImages<F>& images, const Texture& texture, ColorSpace space, const DoubleOf<F>& u,
                       const DoubleOf<F>& v, const MaskOf<F>& nearest) {
  LaneArray<IntOf<F>> widths, heights;
  for (size_t k = 0; k < kWidthOf<F>; ++k) widths[k] = images[k]->width, heights[k] = images[k]->height;
  const IntOf<F> width = widths.load();
  const TexelPair<F> x = neighbours<F>(u, texture.wrap_u, width, nearest);
  const TexelPair<F> y = neighbours<F>(v, texture.wrap_v, heights.load(), nearest);
  switch (images[0]->channels) {
    case 1:
      return filtered<1, F>(images, space, width, x, y);
    case 2:
      return filtered<2, F>(images, space, width, x, y);
    case 3:
      return filtered<3, F>(images, space, width, x, y);
    default:
      return filtered<4, F>(images, space, width, x, y);
  }
}

/// The mip level at which a texel is as large as the footprint; 0 where a texel is larger.
template <class F>
F level_of(const TextureImage& image, const TextureUse& use, const BasicSurfaceInputs<F>& inputs) {
  if (!inputs.uv_per_metre || int64_t{use.uv_set} >= inputs.uv_count) return F(0);
  const float scale = std::sqrt(std::abs(use.xx * use.yy - use.xy * use.yx) * float(image.width) * float(image.height));
  const F texels = inputs.footprint * inputs.uv_per_metre[use.uv_set] * scale;
  const MaskOf<F> smaller_texels = texels > F(1);
  if (!any_of(smaller_texels)) return F(0);
  using std::log2;
  return select(smaller_texels, F(log2(clamped(texels, 1, 1e9f))), F(0));
}

}  // namespace

template <class F>
BasicRgba<F> sample_used(const TextureTable& table, const TextureUse& use, ColorSpace space,
                         const BasicSurfaceInputs<F>& inputs) noexcept {
  using D = DoubleOf<F>;
  if (!table.textures || !table.images || use.texture >= table.textures->size()) return {};
  const Texture& texture = (*table.textures)[use.texture];
  if (texture.image >= table.images->size()) return {};
  const TextureImage& image = (*table.images)[texture.image];
  if (image.width <= 0 || image.height <= 0 || image.channels < 1 || image.channels > 4) return {};

  D u(0), v(0);
  if (inputs.uvs && int64_t{use.uv_set} < inputs.uv_count) {
    const D x = convert<D>(inputs.uvs[use.uv_set].x), y = convert<D>(inputs.uvs[use.uv_set].y);
    const auto finite = is_finite_number(x) && is_finite_number(y);
    u = select(finite, x, D(0)), v = select(finite, y, D(0));
  }
  const D tu = D(double(use.xx)) * u + D(double(use.xy)) * v + D(double(use.x0));
  const D tv = D(double(use.yx)) * u + D(double(use.yy)) * v + D(double(use.y0));
  const auto finite = is_finite_number(tu) && is_finite_number(tv);
  const D folded_u = fold(select(finite, tu, D(0)), texture.wrap_u);
  const D folded_v = fold(select(finite, tv, D(0)), texture.wrap_v);

  const F level = texture.mipmaps == Mipmaps::none || image.smaller.empty() ? F(0) : level_of(image, use, inputs);
  const MaskOf<F> enlarged = !(level > F(0));
  const auto nearest = [&](bool large, bool small) {
    return large == small ? MaskOf<F>(large) : large ? enlarged : !enlarged;
  };
  // Two neighbouring levels in each lane, and how much of the smaller one.
  using I = IntOf<F>;
  const I last(int(image.smaller.size()));
  const F rounded = texture.mipmaps == Mipmaps::nearest ? rounded_down(F(level + F(0.5f))) : level;
  const I below = smaller(convert<I>(rounded), last);
  const F fraction = select(convert_mask<F>(below < last), F(rounded - convert<F>(below)), F(0));
  LaneArray<I> numbers;
  numbers.store(below);
  LevelImages<F> large, small;
  const auto at_level = [&](size_t k) { return k == 0 ? &image : &image.smaller[k - 1]; };
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    large[k] = at_level(size_t(numbers[k]));
    small[k] = at_level(std::min(size_t(numbers[k]) + 1, image.smaller.size()));
  }
  const BasicRgba<F> first =
      at_levels<F>(large, texture, space, folded_u, folded_v, nearest(texture.nearest, texture.nearest_small));
  if (!any_of(fraction > F(0))) return first;
  const MaskOf<F> nearest_small(texture.nearest_small);
  return mix(first, at_levels<F>(small, texture, space, folded_u, folded_v, nearest_small), fraction);
}

template BasicRgba<float> sample_used(const TextureTable&, const TextureUse&, ColorSpace,
                                      const BasicSurfaceInputs<float>&) noexcept;
template BasicRgba<ShadingLanes> sample_used(const TextureTable&, const TextureUse&, ColorSpace,
                                             const BasicSurfaceInputs<ShadingLanes>&) noexcept;

float linear_from_srgb(float encoded) noexcept {
  if (encoded == 1) return 1;
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgb_from_linear(float linear) noexcept {
  if (linear == 1) return 1;
  return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

}  // namespace alhazen
