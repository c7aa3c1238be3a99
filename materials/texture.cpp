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
Neighbours<F, IntOf<F>> neighbours(const DoubleOf<F>& folded, Wrap wrap, const IntOf<F>& size,
                                   const MaskOf<F>& nearest) {
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

/// Texels of any kind, lane by lane.
template <int channels, class T, class F>
struct TexelsOneByOne {
  const T* samples;
  ColorSpace space;

  BasicRgba<F> operator()(const IntOf<F>& columns, const AddressOf<F>& rows) const {
    LaneArray<AddressOf<F>> texels;
    texels.store(rows + convert<AddressOf<F>>(columns));
    RgbaArray<F> colors;
    for (size_t k = 0; k < kWidthOf<F>; ++k)
      colors.set(k, texel<channels>(samples + size_t(texels[k]) * channels, space));
    return colors.load();
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
  const std::vector<uint8_t>& samples;  // 8 to kMostBytes
  ColorSpace space;

  BasicRgba<F> operator()(const I& column, const A& row) const { return decoded(convert<I>(word(column, row))); }

  /// Those of a column and the next.
  std::array<BasicRgba<F>, 2> pair(const I& column, const A& row) const {
    const A both = word(column, row);
    return {decoded(convert<I>(both)), decoded(convert<I>(A(both >> (8 * channels))))};
  }

 private:
  /// Eight bytes from the texel on, its first in the lowest ones; what lies beyond the image is 0.
  A word(const I& column, const A& row) const {
    const I offset = (convert<I>(row) + column) * I(channels), at = smaller(offset, I(int32_t(samples.size()) - 8));
    return load_words<F>(samples.data(), at) >> convert<A>((offset - at) * I(8));
  }

  BasicRgba<F> decoded(const I& bytes) const {
    const auto channel = [&](int c, ColorSpace of_channel) {
      const I byte = (bytes >> (8 * c)) & I(0xFF);
      return of_channel == ColorSpace::srgb ? entry_of_byte<F>(kBytes[size_t(ColorSpace::srgb)], byte)
                                            : linear_byte<F>(convert<F>(byte));
    };
    const F r = channel(0, space), a = channels % 2 ? F(1) : channel(channels - 1, ColorSpace::linear);
    if constexpr (channels < 3)
      return {BasicRgb<F>(r), a};
    else
      return {{r, channel(1, space), channel(2, space)}, a};
  }
};

constexpr size_t kMostBytes = std::numeric_limits<int32_t>::max();

template <class F, class Texels>
BasicRgba<F> filtered(const Texels& texels, const LevelTexels<F>& at) {
  const auto in_row = [&](const AddressOf<F>& row) {
    if constexpr (requires { texels.pair(at.column.a, row); }) {
      if (at.beside) {
        const std::array<BasicRgba<F>, 2> pair = texels.pair(at.column.a, row);
        return mix(pair[0], pair[1], at.column.t);
      }
    }
    return mix(texels(at.column.a, row), texels(at.column.b, row), at.column.t);
  };
  return mix(in_row(at.row.a), in_row(at.row.b), at.row.t);
}

template <int channels, class F>
BasicRgba<F> filtered(const TextureImage& image, ColorSpace space, const LevelTexels<F>& at) {
  return std::visit(
      [&]<class T>(const std::vector<T>& samples) {
        if constexpr (IsLanes<F> && std::is_same_v<T, uint8_t>)
          if (samples.size() >= 8 && samples.size() <= kMostBytes)
            return filtered(TexelsOfBytes<channels, F>{samples, space}, at);
        return filtered(TexelsOneByOne<channels, T, F>{samples.data(), space}, at);
      },
      image.samples);
}

template <class F>
BasicRgba<F> filtered(const TextureImage& image, ColorSpace space, const LevelTexels<F>& at) {
  switch (image.channels) {
    case 1:
      return filtered<1, F>(image, space, at);
    case 2:
      return filtered<2, F>(image, space, at);
    case 3:
      return filtered<3, F>(image, space, at);
    default:
      return filtered<4, F>(image, space, at);
  }
}

/// The mip level of each lane.
template <class F>
struct LaneLevels {
  IntOf<F> width, height;
  AddressOf<F> first_texel;

  /// Those of the numbers, or the last.
  LaneLevels(const TextureImage& image, const IntOf<F>& numbers) {
    LaneArray<IntOf<F>> number, w, h;
    LaneArray<AddressOf<F>> first;
    number.store(numbers);
    MipLevel level{image.width, image.height};
    int known = 0;
    std::array<MipLevel, std::numeric_limits<int>::digits + 1> levels{level};
    for (size_t k = 0; k < kWidthOf<F>; ++k) {
      const int n = std::min(number[k], image.levels - 1);
      for (; known < n; ++known) levels[size_t(known) + 1] = levels[size_t(known)].next();
      w[k] = levels[size_t(n)].width, h[k] = levels[size_t(n)].height, first[k] = levels[size_t(n)].first_texel;
    }
    width = w.load(), height = h.load(), first_texel = first.load();
  }
};

template <class F>
LevelTexels<F> texels_at(const LaneLevels<F>& level, const Texture& sampler, const DoubleOf<F>& u, const DoubleOf<F>& v,
                         const MaskOf<F>& nearest) {
  using A = AddressOf<F>;
  const auto column = neighbours<F>(u, sampler.wrap_u, level.width, nearest);
  const auto row = neighbours<F>(v, sampler.wrap_v, level.height, nearest);
  const A width = convert<A>(level.width);
  const auto start = [&](const IntOf<F>& y) { return A(level.first_texel + convert<A>(y) * width); };
  return {column, {start(row.a), start(row.b), row.t}, !any_of(column.b != column.a + IntOf<F>(1))};
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

  const F level = sampler.mipmaps == Mipmaps::none || image.levels == 1 ? F(0) : level_of(image, use, inputs);
  const MaskOf<F> enlarged = !(level > F(0));
  const auto nearest = [&](bool large, bool small) {
    return large == small ? MaskOf<F>(large) : large ? enlarged : !enlarged;
  };
  // Two neighbouring levels in each lane, and how much of the smaller one.
  const I last(image.levels - 1);
  const F rounded = sampler.mipmaps == Mipmaps::nearest ? rounded_down(F(level + F(0.5f))) : level;
  const I large = smaller(convert<I>(rounded), last);
  lookup.fraction = select(convert_mask<F>(large < last), F(rounded - convert<F>(large)), F(0));
  lookup.large = texels_at(LaneLevels<F>(image, large), sampler, folded_u, folded_v,
                           nearest(sampler.nearest, sampler.nearest_small));
  if (any_of(lookup.fraction > F(0)))
    lookup.small =
        texels_at(LaneLevels<F>(image, large + I(1)), sampler, folded_u, folded_v, MaskOf<F>(sampler.nearest_small));
}

template <class F>
typename TextureLookup<F>::Key key_of(const TextureImage& image, const Texture& sampler, const TextureUse& use,
                                      const BasicSurfaceInputs<F>& inputs) {
  typename TextureLookup<F>::Key key{use, sampler, image.width, image.height, image.levels, !inputs.uv_per_metre};
  key.use.texture = key.sampler.image = kNone;
  return key;
}

/// The image of a use, if it has texels.
const TextureImage* image_of(const TextureTable& table, const TextureUse& use) {
  if (!table.textures || !table.images || use.texture >= table.textures->size()) return nullptr;
  const Texture& texture = (*table.textures)[use.texture];
  if (texture.image >= table.images->size()) return nullptr;
  const TextureImage& image = (*table.images)[texture.image];
  return image.width > 0 && image.height > 0 && image.channels >= 1 && image.channels <= 4 ? &image : nullptr;
}

}  // namespace

template <class F>
BasicRgba<F> sample_used(const TextureTable& table, const TextureUse& use, ColorSpace space,
                         const BasicSurfaceInputs<F>& inputs) noexcept {
  const TextureImage* image = image_of(table, use);
  if (!image) return {};
  const Texture& texture = (*table.textures)[use.texture];

  TextureLookup<F> own;
  TextureLookup<F>& lookup = inputs.lookup ? *inputs.lookup : own;
  if (const auto key = key_of<F>(*image, texture, use, inputs); lookup.key != key) {
    find_texels(*image, texture, use, inputs, lookup);
    lookup.key = key;
  }
  const BasicRgba<F> large = filtered<F>(*image, space, lookup.large);
  if (!any_of(lookup.fraction > F(0))) return large;
  return mix(large, filtered<F>(*image, space, lookup.small), lookup.fraction);
}

template <class F>
void prefetch(const TextureTable& table, std::span<const TextureUse* const> uses,
              const BasicSurfaceInputs<F>& inputs) noexcept {
  TextureLookup<F>& lookup = *inputs.lookup;
  // A byte of each row that is mixed: neighbours lie in one line of the cache, mostly.
  std::array<LaneArray<AddressOf<F>>, 4> texels;
  size_t rows = 0;
  const auto add = [&](const LevelTexels<F>& at) {
    for (const AddressOf<F>& row : {at.row.a, at.row.b}) texels[rows++].store(row + convert<AddressOf<F>>(at.column.a));
  };
  for (const TextureUse* use : uses) {
    const TextureImage* image = image_of(table, *use);
    if (!image) continue;
    const Texture& texture = (*table.textures)[use->texture];
    const auto key = key_of<F>(*image, texture, *use, inputs);
    if (rows == 0) {
      find_texels(*image, texture, *use, inputs, lookup);
      lookup.key = key;
      add(lookup.large);
      if (any_of(lookup.fraction > F(0))) add(lookup.small);
    }
    if (lookup.key != key) continue;
    const auto samples =
        std::visit([](const auto& all) { return std::as_bytes(std::span(all)).data(); }, image->samples);
    const size_t sample_size = std::visit([](const auto& all) { return sizeof all[0]; }, image->samples);
    const size_t texel_size = size_t(image->channels) * sample_size;
    // Here and not in a function of its own: that, GCC 12 takes for one without an effect.
    for (size_t row = 0; row < rows; ++row)
      for (const uint64_t texel : texels[row].values) __builtin_prefetch(samples + texel * texel_size);
  }
}

template void prefetch(const TextureTable&, std::span<const TextureUse* const>,
                       const BasicSurfaceInputs<ShadingLanes>&) noexcept;
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
