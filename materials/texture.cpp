#include "materials/texture.h"

#include <algorithm>
#include <cstddef>

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

template <int channels, class T, class F>
BasicRgba<F> filtered(const LevelImages<F>& images, const TexelPair<F>& x, const TexelPair<F>& y, ColorSpace space) {
  RgbaArray<F> t00, t10, t01, t11;
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    const TextureImage& image = *images[k];
    const T* samples = std::get_if<std::vector<T>>(&image.samples)->data();
    const T *above = samples + size_t(y.a[k]) * size_t(image.width) * channels,
            *below = samples + size_t(y.b[k]) * size_t(image.width) * channels;
    const size_t left = size_t(x.a[k]) * channels, right = size_t(x.b[k]) * channels;
    t00.set(k, texel<channels>(above + left, space)), t10.set(k, texel<channels>(above + right, space));
    t01.set(k, texel<channels>(below + left, space)), t11.set(k, texel<channels>(below + right, space));
  }
  return mix(mix(t00.load(), t10.load(), x.t), mix(t01.load(), t11.load(), x.t), y.t);
}

template <class T, class F>
BasicRgba<F> filtered(const LevelImages<F>& images, const TexelPair<F>& x, const TexelPair<F>& y, ColorSpace space) {
  switch (images[0]->channels) {
    case 1:
      return filtered<1, T, F>(images, x, y, space);
    case 2:
      return filtered<2, T, F>(images, x, y, space);
    case 3:
      return filtered<3, T, F>(images, x, y, space);
    default:
      return filtered<4, T, F>(images, x, y, space);
  }
}

template <class F>
BasicRgba<F> at_levels(const LevelImages<F>& images, const Texture& texture, ColorSpace space, const DoubleOf<F>& u,
                       const DoubleOf<F>& v, const MaskOf<F>& nearest) {
  LaneArray<IntOf<F>> width, height;
  for (size_t k = 0; k < kWidthOf<F>; ++k) width[k] = images[k]->width, height[k] = images[k]->height;
  const TexelPair<F> x = neighbours<F>(u, texture.wrap_u, width.load(), nearest);
  const TexelPair<F> y = neighbours<F>(v, texture.wrap_v, height.load(), nearest);
  switch (images[0]->samples.index()) {
    case 0:
      return filtered<uint8_t, F>(images, x, y, space);
    case 1:
      return filtered<uint16_t, F>(images, x, y, space);
    default:
      return filtered<float, F>(images, x, y, space);
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
  LevelImages<F> large, small;
  LaneArray<F> levels, fraction;
  levels.store(level);
  bool between = false;
  const auto at_level = [&](size_t k) { return k == 0 ? &image : &image.smaller[k - 1]; };
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    const size_t last = image.smaller.size();
    const float rounded = texture.mipmaps == Mipmaps::nearest ? std::round(levels[k]) : levels[k];
    const size_t below = std::min(size_t(rounded), last);
    fraction[k] = below < last ? rounded - float(below) : 0;
    between = between || fraction[k] > 0;
    large[k] = at_level(below), small[k] = at_level(std::min(below + 1, last));
  }
  const BasicRgba<F> first =
      at_levels<F>(large, texture, space, folded_u, folded_v, nearest(texture.nearest, texture.nearest_small));
  if (!between) return first;
  const MaskOf<F> nearest_small(texture.nearest_small);
  return mix(first, at_levels<F>(small, texture, space, folded_u, folded_v, nearest_small), fraction.load());
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
