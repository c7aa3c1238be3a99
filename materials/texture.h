// Decoded images and how a surface looks them up.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/lane_vec.h"

namespace alhazen {

struct TexelRecords;

enum class ColorSpace : uint8_t { linear, srgb };

/// A decoded image as its file had it: rows from the top left, 1 to 4 interleaved channels (grey, grey-alpha, RGB,
/// RGBA), straight alpha, samples not linearised. Eight bits stay eight bits. An image that could not be decoded has
/// width 0 and reads as opaque white.
struct TextureImage {
  int width = 0, height = 0, channels = 0;                                                // of level 0
  std::variant<std::vector<uint8_t>, std::vector<uint16_t>, std::vector<float>> samples;  // level after level
  int levels = 1;                                                                         // mip levels
  // Where its texels lie in records together with those of other images, `samples` are empty.
  std::shared_ptr<const TexelRecords> records = nullptr;
  size_t first_byte = 0;                  // of each record
  ColorSpace space = ColorSpace::linear;  // of its colours there
};

/// Of a mip level: its size, and how many texels the levels before it have.
struct MipLevel {
  int width = 0, height = 0;
  size_t first_texel = 0;

  /// Half as wide and high, rounded down, at least 1.
  [[nodiscard]] MipLevel next() const {
    return {width > 1 ? width / 2 : 1, height > 1 ? height / 2 : 1, first_texel + size_t(width) * size_t(height)};
  }
};

enum class Wrap : uint8_t { repeat, mirrored_repeat, clamp_to_edge };

/// How a sampler goes from one mip level to the next.
enum class Mipmaps : uint8_t { none, nearest, linear };

/// A glTF texture: an image and its sampler.
struct Texture {
  uint32_t image = kNone;  // into Scene::images; kNone reads as opaque white
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;        // magFilter NEAREST; else bilinear
  bool nearest_small = false;  // minFilter NEAREST, NEAREST_MIPMAP_...; else bilinear
  Mipmaps mipmaps = Mipmaps::linear;

  friend bool operator==(const Texture&, const Texture&) = default;
};

/// A material's use of a texture (glTF textureInfo with KHR_texture_transform).
struct TextureUse {
  uint32_t texture = kNone;  // into Scene::textures; kNone: not used, reads as opaque white
  uint32_t uv_set = 0;       // TEXCOORD_n, after KHR_texture_transform's override; below kMaxUvSets
  // uv' = (xx u + xy v + x0, yx u + yy v + y0): translation * rotation * scale of KHR_texture_transform.
  float xx = 1, xy = 0, x0 = 0, yx = 0, yy = 1, y0 = 0;

  [[nodiscard]] explicit operator bool() const { return texture != kNone; }
  friend bool operator==(const TextureUse&, const TextureUse&) = default;
};

/// Two texels beside each other, or two rows, in each lane.
template <class F, class Number>
struct Neighbours {
  Number a, b;
  F t;  // weight of b
};

/// The texels of one mip level in each lane that a look-up mixes.
template <class F>
struct LevelTexels {
  Neighbours<F, IntOf<F>> column;
  Neighbours<F, AddressOf<F>> row;  // numbers of their first texels
  bool beside = false;              // in every lane, column.b follows column.a
};

/// Where a look-up's texels lie. Textures of one size that are used alike, as those of a material mostly are, have it
/// in common; found for one, it is there for the others.
template <class F>
struct TextureLookup {
  struct Key {
    TextureUse use;   // of no texture
    Texture sampler;  // of no image
    int width = 0, height = 0, levels = 0;
    bool of_point = false;  // whatever the footprint
    friend bool operator==(const Key&, const Key&) = default;
  } key;                        // no width: nothing is found yet
  F fraction;                   // of the smaller level of two
  LevelTexels<F> large, small;  // `small` where fractions are not 0

  /// The last records that were mixed, for all images that have a part in them.
  struct Mixed {
    const TexelRecords* records = nullptr;
    Key key;
    std::array<LaneArray<F>, kWidthOf<F>> bytes;  // of each lane, decoded
  } mixed;
};

/// What a surface brings to a material: interpolated at the hit. Of lanes: at each of their hits.
template <class F>
struct BasicSurfaceInputs {
  const Vec2<F>* uvs = nullptr;
  int uv_count = 0;
  BasicRgba<F> color;                  // vertex colour; white where the mesh has none
  F footprint = 0;                     // metres of the surface that a look-up stands for; 0: a point
  const F* uv_per_metre = nullptr;     // for each of `uvs`; none, or 0: unknown, a point is looked up
  TextureLookup<F>* lookup = nullptr;  // the last one for this surface, if it is kept
};
using SurfaceInputs = BasicSurfaceInputs<float>;

/// What texture look-ups read; views into a Scene.
struct TextureTable {
  const std::vector<Texture>* textures = nullptr;
  const std::vector<TextureImage>* images = nullptr;
};

/// The texture at a point, or over its footprint where the texture has mipmaps. A UV set that the surface lacks reads
/// as (0, 0).
///
/// Texel centres lie at half integers; wrapping is exact for any finite uv (non-finite reads as (0, 0)). With `srgb`
/// the colour channels are decoded (IEC 61966-2-1) texel by texel before they are filtered; alpha never is. Grey fills
/// r, g, b; a missing alpha is 1.
template <class F = float>
[[nodiscard]] BasicRgba<F> sample_used(const TextureTable& table, const TextureUse& use, ColorSpace space,
                                       const BasicSurfaceInputs<F>& inputs) noexcept;

/// The same; most materials use few of the textures that they might.
template <class F = float>
[[nodiscard]] BasicRgba<F> sample(const TextureTable& table, const TextureUse& use, ColorSpace space,
                                  const BasicSurfaceInputs<F>& inputs) noexcept {
  return use ? sample_used(table, use, space, inputs) : BasicRgba<F>{};
}

/// Asks for the memory that look-ups of these uses will read, so that they wait for it together. The texels of the
/// first are found, into `inputs.lookup`; asked for are all textures' that lie as they do.
template <class F>
void prefetch(const TextureTable& table, std::span<const TextureUse* const> uses,
              const BasicSurfaceInputs<F>& inputs) noexcept;

/// As many points as are shaded at once: what look-ups and materials are compiled for beside single points.
using ShadingLanes = std::experimental::native_simd<float>;

/// Whether lanes are as many as a record of texels has bytes.
inline constexpr bool kMixesRecords =
#if defined __AVX512F__ && defined __GLIBCXX__
    kWidthOf<ShadingLanes> == 16;
#else
    false;
#endif

/// IEC 61966-2-1 and back, for one channel. Exact at 0 and 1.
[[nodiscard]] float linear_from_srgb(float encoded) noexcept;
[[nodiscard]] float srgb_from_linear(float linear) noexcept;

}  // namespace alhazen
