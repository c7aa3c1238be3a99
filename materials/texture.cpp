#include "materials/texture.h"

#include <algorithm>
#include <cstddef>

#include "core/lane_memory.h"
#include "materials/byte_tables.h"
#include "materials/texel_places.h"
#include "materials/texel_records.h"

namespace alhazen {
namespace {

inline float decode(uint8_t v, ColorSpace space) { return kLightOfByte[size_t(space)][v]; }
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

/// Texels of any kind, lane by lane, `stride` samples apart.
template <int channels, class T, class F>
struct TexelsOneByOne {
  const T* samples;
  size_t stride;
  ColorSpace space;

  BasicRgba<F> operator()(const IntOf<F>& columns, const AddressOf<F>& rows) const {
    LaneArray<AddressOf<F>> texels;
    texels.store(rows + convert<AddressOf<F>>(columns));
    RgbaArray<F> colors;
    for (size_t k = 0; k < kWidthOf<F>; ++k)
      colors.set(k, texel<channels>(samples + size_t(texels[k]) * stride, space));
    return colors.load();
  }
};

/// Texels of bytes, in all lanes at once: a row's neighbours by one fetch of eight bytes where they lie side by side.
template <int channels, class F>
struct TexelsOfBytes {
  using I = IntOf<F>;
  using A = AddressOf<F>;
  std::span<const uint8_t> samples;  // 8 to kMostBytes
  int stride, first;                 // a texel's first byte is number stride * texel + first
  ColorSpace space;

  [[nodiscard]] bool has_pairs() const { return stride == channels; }

  BasicRgba<F> operator()(const I& column, const A& row) const { return decoded(convert<I>(word(column, row))); }

  /// Those of a column and the next.
  std::array<BasicRgba<F>, 2> pair(const I& column, const A& row) const {
    const A both = word(column, row);
    return {decoded(convert<I>(both)), decoded(convert<I>(A(both >> (8 * channels))))};
  }

 private:
  /// Eight bytes from the texel on, its first in the lowest ones; what lies beyond the image is 0.
  A word(const I& column, const A& row) const {
    const I offset = (convert<I>(row) + column) * I(stride) + I(first),
            at = smaller(offset, I(int32_t(samples.size()) - 8));
    return load_words<F>(samples.data(), at) >> convert<A>((offset - at) * I(8));
  }

  BasicRgba<F> decoded(const I& bytes) const {
    const auto channel = [&](int c, ColorSpace of_channel) {
      const I byte = (bytes >> (8 * c)) & I(0xFF);
      return of_channel == ColorSpace::srgb ? entry_of_byte<F>(kLightOfByte[size_t(ColorSpace::srgb)], byte)
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
      if (at.beside && texels.has_pairs()) {
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
  const auto in = [&]<class T>(std::span<const T> samples, size_t stride, size_t first) {
    if constexpr (IsLanes<F> && std::is_same_v<T, uint8_t>)
      if (samples.size() >= 8 && samples.size() <= kMostBytes)
        return filtered(TexelsOfBytes<channels, F>{samples, int(stride), int(first), space}, at);
    return filtered(TexelsOneByOne<channels, T, F>{samples.data() + first, stride, space}, at);
  };
  if (const TexelRecords* const records = image.records.get())
    return in(std::span<const uint8_t>(records->data.get(), records->bytes), records->size, image.first_byte);
  return std::visit([&](const auto& samples) { return in(std::span(samples), channels, 0); }, image.samples);
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

template <class F>
typename TextureLookup<F>::Key key_of(const TextureImage& image, const Texture& sampler, const TextureUse& use,
                                      const BasicSurfaceInputs<F>& inputs) {
  typename TextureLookup<F>::Key key{use, sampler, image.width, image.height, image.levels, !inputs.uv_per_metre};
  key.use.texture = key.sampler.image = kNone;
  return key;
}

/// Finds the texels, if they are not there yet.
template <class F>
void find_once(const TextureImage& image, const Texture& sampler, const TextureUse& use,
               const BasicSurfaceInputs<F>& inputs, const typename TextureLookup<F>::Key& key,
               TextureLookup<F>& lookup) {
  if (lookup.key == key) return;
  find_texels(image, sampler, use, inputs, lookup);
  lookup.key = key;
}

/// The image of a use, if it has texels.
const TextureImage* image_of(const TextureTable& table, const TextureUse& use) {
  if (!table.textures || !table.images || use.texture >= table.textures->size()) return nullptr;
  const Texture& texture = (*table.textures)[use.texture];
  if (texture.image >= table.images->size()) return nullptr;
  const TextureImage& image = (*table.images)[texture.image];
  return image.width > 0 && image.height > 0 && image.channels >= 1 && image.channels <= 4 ? &image : nullptr;
}

/// An image's texels, `stride` bytes apart, in records that it may share.
struct TexelMemory {
  const std::byte* first;
  size_t stride;
  bool is_shared;
};
TexelMemory memory_of(const TextureImage& image) {
  if (const TexelRecords* const records = image.records.get())
    return {std::as_bytes(std::span(records->data.get(), records->bytes)).data(), records->size, true};
  const auto memory = [&](const auto& samples) {
    return TexelMemory{std::as_bytes(std::span(samples)).data(), size_t(image.channels) * sizeof samples[0], false};
  };
  return std::visit(memory, image.samples);
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
  const auto key = key_of<F>(*image, texture, use, inputs);
  if constexpr (IsLanes<F> && kMixesRecords)
    if (inputs.lookup && image->records && image->space == space) {
      if (lookup.mixed.records != image->records.get() || lookup.mixed.key != key) {
        find_once(*image, texture, use, inputs, key, lookup);
        mix_records(*image->records, lookup);
        lookup.mixed.records = image->records.get(), lookup.mixed.key = key;
      }
      return part_of(lookup.mixed, *image);
    }
  find_once(*image, texture, use, inputs, key, lookup);
  const BasicRgba<F> large = filtered<F>(*image, space, lookup.large);
  if (!any_of(lookup.fraction > F(0))) return large;
  return mix(large, filtered<F>(*image, space, lookup.small), lookup.fraction);
}

template <class F>
void prefetch(const TextureTable& table, std::span<const TextureUse* const> uses,
              const BasicSurfaceInputs<F>& inputs) noexcept {
  TextureLookup<F>& lookup = *inputs.lookup;
  // A byte of each row that is mixed: neighbours lie in one line of the cache, mostly; of records the last one, too.
  std::array<LaneArray<AddressOf<F>>, 4> texels;
  size_t rows = 0;
  const std::byte* asked = nullptr;
  const auto add = [&](const LevelTexels<F>& at) {
    for (const AddressOf<F>& row : {at.row.a, at.row.b}) texels[rows++].store(row + convert<AddressOf<F>>(at.column.a));
  };
  for (const TextureUse* use : uses) {
    const TextureImage* image = image_of(table, *use);
    if (!image) continue;
    const Texture& texture = (*table.textures)[use->texture];
    const auto key = key_of<F>(*image, texture, *use, inputs);
    if (rows == 0) {
      find_once(*image, texture, *use, inputs, key, lookup);
      add(lookup.large);
      if (any_of(lookup.fraction > F(0))) add(lookup.small);
    }
    if (lookup.key != key) continue;
    const TexelMemory memory = memory_of(*image);
    if (memory.first == asked) continue;
    asked = memory.first;
    // Here and not in a function of its own: that, GCC 12 takes for one without an effect.
    for (size_t row = 0; row < rows; ++row)
      for (const uint64_t texel : texels[row].values) {
        const std::byte* const left = memory.first + texel * memory.stride;
        __builtin_prefetch(left);
        if (memory.is_shared) __builtin_prefetch(left + 2 * memory.stride - 1);
      }
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
