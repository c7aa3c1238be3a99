#include "materials/texel_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Where the levels of an image begin.
struct LevelTable {
  int width, height;  // of level 0
  std::array<uint64_t, std::numeric_limits<int>::digits + 1> first_texel;

  explicit LevelTable(const TextureImage& image) : width(image.width), height(image.height) {
    MipLevel level{width, height};
    for (int k = 0; k < image.levels; ++k, level = level.next()) first_texel[size_t(k)] = level.first_texel;
  }
};

/// The mip level of each lane.
template <class F>
struct LaneLevels {
  IntOf<F> width, height;
  AddressOf<F> first_texel;

  /// Of numbers that the image has.
  LaneLevels(const LevelTable& table, const IntOf<F>& numbers) {
    using I = IntOf<F>;
    width = larger(I(I(table.width) >> numbers), I(1)), height = larger(I(I(table.height) >> numbers), I(1));
    first_texel = load_words_at<F>(address_of(table.first_texel.data(), numbers));
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

}  // namespace

template <class F>
void find_texels(const TextureImage& image, const Texture& sampler, const TextureUse& use,
                 const BasicSurfaceInputs<F>& inputs, TextureLookup<F>& lookup) noexcept {
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
  const LevelTable levels(image);
  lookup.large = texels_at(LaneLevels<F>(levels, large), sampler, folded_u, folded_v,
                           nearest(sampler.nearest, sampler.nearest_small));
  if (any_of(lookup.fraction > F(0)))
    lookup.small = texels_at(LaneLevels<F>(levels, smaller(large + I(1), last)), sampler, folded_u, folded_v,
                             MaskOf<F>(sampler.nearest_small));
}

template void find_texels(const TextureImage&, const Texture&, const TextureUse&, const BasicSurfaceInputs<float>&,
                          TextureLookup<float>&) noexcept;
template void find_texels(const TextureImage&, const Texture&, const TextureUse&,
                          const BasicSurfaceInputs<ShadingLanes>&, TextureLookup<ShadingLanes>&) noexcept;

}  // namespace alhazen
