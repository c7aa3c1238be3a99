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
  return {select(only, there, inner_a), select(only, there, inner_b),
          select(nearest, F(0), convert<F>(D(x - D(0.5) - low)))};
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

  BasicRgba<F> operator()(const IntOf<F>& xs, const IntOf<F>& ys) const {
    LaneArray<IntOf<F>> x, y;
    x.store(xs), y.store(ys);
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

/// Texels of bytes, in all lanes at once: a row's neighbours by one fetch of eight bytes.
template <int channels, class F>
struct TexelsOfBytes {
  using I = IntOf<F>;
  using A = AddressOf<F>;
  A samples;
  I width, last_word;  // where the image's last eight bytes begin
  ColorSpace space;

  BasicRgba<F> operator()(const I& x, const I& y) const { return decoded(convert<I>(word(x, y))); }

  /// Those at x and x + 1.
  std::array<BasicRgba<F>, 2> pair(const I& x, const I& y) const {
    const A both = word(x, y);
    return {decoded(convert<I>(both)), decoded(convert<I>(A(both >> (8 * channels))))};
  }

 private:
  /// Eight bytes from the texel on, its first in the lowest ones; what lies beyond the image is 0.
  A word(const I& x, const I& y) const {
    const I offset = (y * width + x) * I(channels), at = smaller(offset, last_word);
    return load_words_at<F>(samples + convert<A>(at)) >> convert<A>((offset - at) * I(8));
  }

  BasicRgba<F> decoded(const I& bytes) const {
    const auto channel = [&](int c, ColorSpace of_channel) {
      const I byte = (bytes >> (8 * c)) & I(0xFF);
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
BasicRgba<F> filtered(const Texels& texels, const LevelTexels<F>& at) {
  const auto row = [&](const IntOf<F>& y) {
    if constexpr (requires { texels.pair(at.x.a, y); }) {
      if (at.in_rows) {
        const std::array<BasicRgba<F>, 2> pair = texels.pair(at.x.a, y);
        return mix(pair[0], pair[1], at.x.t);
      }
    }
    return mix(texels(at.x.a, y), texels(at.x.b, y), at.x.t);
  };
  return mix(row(at.y.a), row(at.y.b), at.y.t);
}

template <int channels, class F>
BasicRgba<F> filtered(const LevelImages<F>& images, bool one_image, ColorSpace space, const LevelTexels<F>& at) {
  const TextureImage& image = *images[0];
  if (std::holds_alternative<std::vector<uint16_t>>(image.samples))
    return filtered(TexelsOneByOne<channels, uint16_t, F>{images, space}, at);
  if (std::holds_alternative<std::vector<float>>(image.samples))
    return filtered(TexelsOneByOne<channels, float, F>{images, space}, at);
  if constexpr (IsLanes<F>) {
    const auto bytes_of = [&](size_t k) -> const auto& {
      return *std::get_if<std::vector<uint8_t>>(&images[k]->samples);
    };
    const auto fit = [](size_t size) { return size >= 8 && size <= size_t(std::numeric_limits<int32_t>::max()); };
    const auto fetched = [&](const AddressOf<F>& samples, const IntOf<F>& last_word) {
      return filtered(TexelsOfBytes<channels, F>{samples, at.width, last_word, space}, at);
    };
    if (one_image) {
      const auto& bytes = bytes_of(0);
      if (fit(bytes.size()))
        return fetched(AddressOf<F>(reinterpret_cast<uintptr_t>(bytes.data())), IntOf<F>(int32_t(bytes.size()) - 8));
    } else {
      LaneArray<AddressOf<F>> samples;
      LaneArray<IntOf<F>> last_word;
      bool all_fit = true;
      for (size_t k = 0; k < kWidthOf<F>; ++k) {
        const auto& bytes = bytes_of(k);
        all_fit = all_fit && fit(bytes.size());
        samples[k] = reinterpret_cast<uintptr_t>(bytes.data()), last_word[k] = int32_t(bytes.size()) - 8;
      }
      if (all_fit) return fetched(samples.load(), last_word.load());
    }
  }
  return filtered(TexelsOneByOne<channels, uint8_t, F>{images, space}, at);
}

template <class F>
BasicRgba<F> filtered(const LevelImages<F>& images, bool one_image, ColorSpace space, const LevelTexels<F>& at) {
  switch (images[0]->channels) {
    case 1:
      return filtered<1, F>(images, one_image, space, at);
    case 2:
      return filtered<2, F>(images, one_image, space, at);
    case 3:
      return filtered<3, F>(images, one_image, space, at);
    default:
      return filtered<4, F>(images, one_image, space, at);
  }
}

template <class F>
LevelTexels<F> texels_at(const LevelImages<F>& images, const Texture& sampler, const DoubleOf<F>& u,
                         const DoubleOf<F>& v, const MaskOf<F>& nearest) {
  LaneArray<IntOf<F>> width, height;
  for (size_t k = 0; k < kWidthOf<F>; ++k) width[k] = images[k]->width, height[k] = images[k]->height;
  LevelTexels<F> at{width.load(), neighbours<F>(u, sampler.wrap_u, width.load(), nearest),
                    neighbours<F>(v, sampler.wrap_v, height.load(), nearest)};
  at.in_rows = !any_of(at.x.b != at.x.a + IntOf<F>(1));
  return at;
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

/// The level `beyond` the larger one of each lane, or the last.
template <class F>
LevelImages<F> images_at(const TextureImage& image, const LaneArray<IntOf<F>>& level, size_t beyond) {
  LevelImages<F> images;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    const size_t number = std::min(size_t(level[k]) + beyond, image.smaller.size());
    images[k] = number == 0 ? &image : &image.smaller[number - 1];
  }
  return images;
}

template <class F>
void find_texels(const TextureImage& image, const Texture& sampler, const TextureUse& use,
                 const BasicSurfaceInputs<F>& inputs, TextureLookup<F>& lookup) {
  using D = DoubleOf<F>;
  using I = IntOf<F>;
  D u(0), v(0);
  if (inputs.uvs && int64_t{use.uv_set} < inputs.uv_count) {
    const D x = convert<D>(inputs.uvs[use.uv_set].x), y = convert<D>(inputs.uvs[use.uv_set].y);
    const auto finite = is_finite_number(x) && is_finite_number(y);
    u = select(finite, x, D(0)), v = select(finite, y, D(0));
  }
  const D tu = D(double(use.xx)) * u + D(double(use.xy)) * v + D(double(use.x0));
  const D tv = D(double(use.yx)) * u + D(double(use.yy)) * v + D(double(use.y0));
  const auto finite = is_finite_number(tu) && is_finite_number(tv);
  const D folded_u = fold(select(finite, tu, D(0)), sampler.wrap_u);
  const D folded_v = fold(select(finite, tv, D(0)), sampler.wrap_v);

  const F level = sampler.mipmaps == Mipmaps::none || image.smaller.empty() ? F(0) : level_of(image, use, inputs);
  const MaskOf<F> enlarged = !(level > F(0));
  const auto nearest = [&](bool large, bool small) {
    return large == small ? MaskOf<F>(large) : large ? enlarged : !enlarged;
  };
  // Two neighbouring levels in each lane, and how much of the smaller one.
  const I last(int(image.smaller.size()));
  const F rounded = sampler.mipmaps == Mipmaps::nearest ? rounded_down(F(level + F(0.5f))) : level;
  const I below = smaller(convert<I>(rounded), last);
  lookup.fraction = select(convert_mask<F>(below < last), F(rounded - convert<F>(below)), F(0));
  lookup.level.store(below);
  lookup.one_level = !any_of(below != I(lookup.level[0]));
  lookup.large = texels_at<F>(images_at<F>(image, lookup.level, 0), sampler, folded_u, folded_v,
                              nearest(sampler.nearest, sampler.nearest_small));
  if (any_of(lookup.fraction > F(0)))
    lookup.small = texels_at<F>(images_at<F>(image, lookup.level, 1), sampler, folded_u, folded_v,
                                MaskOf<F>(sampler.nearest_small));
}

template <class F>
typename TextureLookup<F>::Key key_of(const TextureImage& image, const Texture& sampler, const TextureUse& use) {
  typename TextureLookup<F>::Key key{use, sampler, image.width, image.height, image.smaller.size()};
  key.use.texture = key.sampler.image = kNone;
  return key;
}

}  // namespace

template <class F>
BasicRgba<F> sample_used(const TextureTable& table, const TextureUse& use, ColorSpace space,
                         const BasicSurfaceInputs<F>& inputs) noexcept {
  if (!table.textures || !table.images || use.texture >= table.textures->size()) return {};
  const Texture& texture = (*table.textures)[use.texture];
  if (texture.image >= table.images->size()) return {};
  const TextureImage& image = (*table.images)[texture.image];
  if (image.width <= 0 || image.height <= 0 || image.channels < 1 || image.channels > 4) return {};

  TextureLookup<F> own;
  TextureLookup<F>& lookup = inputs.lookup ? *inputs.lookup : own;
  if (const auto key = key_of<F>(image, texture, use); lookup.key != key) {
    find_texels(image, texture, use, inputs, lookup);
    lookup.key = key;
  }
  const BasicRgba<F> large = filtered<F>(images_at<F>(image, lookup.level, 0), lookup.one_level, space, lookup.large);
  if (!any_of(lookup.fraction > F(0))) return large;
  const BasicRgba<F> small = filtered<F>(images_at<F>(image, lookup.level, 1), lookup.one_level, space, lookup.small);
  return mix(large, small, lookup.fraction);
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
