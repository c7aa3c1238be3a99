// Vectors and colours of lanes, for code that is written once for a number type F: a float, or lanes of floats. Every
// function here gives each lane the bits that the float has.
#pragma once

#include <array>
#include <bit>
#include <cstring>

#include "core/real.h"
#include "core/vec.h"

namespace alhazen {

namespace lane_detail {
template <class F>
struct Wide {
  using Double = double;
  using Int = int32_t;
  using Uint = uint32_t;
  using Address = uint64_t;
};
template <IsLanes F>
struct Wide<F> {
  using Double = LanesOf<double, int(F::size())>;
  using Int = LanesOf<int32_t, int(F::size())>;
  using Uint = LanesOf<uint32_t, int(F::size())>;
  using Address = LanesOf<uint64_t, int(F::size())>;
};
}  // namespace lane_detail

/// As many doubles or 32-bit integers as F has floats.
template <class F>
using DoubleOf = typename lane_detail::Wide<F>::Double;
template <class F>
using IntOf = typename lane_detail::Wide<F>::Int;
template <class F>
using UintOf = typename lane_detail::Wide<F>::Uint;
/// As many addresses.
template <class F>
using AddressOf = typename lane_detail::Wide<F>::Address;

template <class F>
inline constexpr size_t kWidthOf = 1;
template <IsLanes F>
inline constexpr size_t kWidthOf<F> = F::size();

/// Each lane's number in another type: rounded, widened, or cut off towards zero.
template <class To, class From>
constexpr To convert(const From& x) {
  if constexpr (IsLanes<From>)
    return std::experimental::static_simd_cast<To>(x);
  else
    return static_cast<To>(x);
}
template <class To, class From>
Vec3<To> convert(const Vec3<From>& v) {
  return {convert<To>(v.x), convert<To>(v.y), convert<To>(v.z)};
}

/// The mask of numbers of another size.
template <class To, class Mask>
auto convert_mask(const Mask& mask) {
  if constexpr (std::is_same_v<Mask, bool>)
    return mask;
  else
    return std::experimental::__proposed::static_simd_cast<typename To::mask_type>(mask);
}

inline float absolute(float x) { return std::abs(x); }
inline float square_root(float x) { return std::sqrt(x); }

template <class F>
F clamped(const F& x, float low, float high) {
  return select(x < F(low), F(low), select(F(high) < x, F(high), x));
}
/// Into [0, 1]; what is not a number becomes 0.
template <class F>
F unit_clamped(const F& x) {
  return select(x > F(0), smaller(x, F(1)), F(0));
}

template <IsLanes F>
Vec3<F> select(const MaskOf<F>& mask, const Vec3<F>& yes, const Vec3<F>& no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
template <IsLanes F>
BasicRgb<F> select(const MaskOf<F>& mask, const BasicRgb<F>& yes, const BasicRgb<F>& no) {
  return {select(mask, yes.r, no.r), select(mask, yes.g, no.g), select(mask, yes.b, no.b)};
}

template <IsLanes F>
[[nodiscard]] F max_component(const BasicRgb<F>& a) {
  const F gb = select(a.g < a.b, a.b, a.g);
  return select(a.r < gb, gb, a.r);
}
template <IsLanes F>
[[nodiscard]] F length(const Vec3<F>& a) {
  return square_root(dot(a, a));
}
template <IsLanes F>
[[nodiscard]] Vec3<F> normalize(const Vec3<F>& a) {
  const F squared = dot(a, a);
  return select(squared > F(0), a / square_root(squared), a);
}

/// `a` over its length by one division, for one more rounding; 0 stays 0. Of one vector or those of lanes.
template <class F>
[[nodiscard]] Vec3<F> unit_vector(const Vec3<F>& a) {
  const F squared = dot(a, a);
  return select(squared > F(0), a * F(F(1) / square_root(squared)), a);
}

/// One vector in every lane.
template <class F>
Vec3<F> broadcast(const Vec3f& v) {
  return {F(v.x), F(v.y), F(v.z)};
}

/// Numbers of lanes in memory.
template <class F>
struct alignas(64) LaneArray {
  std::array<ScalarOf<F>, kWidthOf<F>> values;

  ScalarOf<F>& operator[](size_t k) { return values[k]; }
  const ScalarOf<F>& operator[](size_t k) const { return values[k]; }
  [[nodiscard]] F load() const {
    if constexpr (IsLanes<F>)
      return F(values.data(), std::experimental::element_aligned);
    else
      return values[0];
  }
  void store(const F& x) {
    if constexpr (IsLanes<F>)
      x.copy_to(values.data(), std::experimental::element_aligned);
    else
      values[0] = x;
  }
};

template <class F>
struct Vec2Array {
  LaneArray<F> x, y;

  [[nodiscard]] Vec2<F> load() const { return {x.load(), y.load()}; }
  void store(const Vec2<F>& v) { x.store(v.x), y.store(v.y); }
};

template <class F>
struct Vec3Array {
  LaneArray<F> x, y, z;

  void set(size_t k, const Vec3<ScalarOf<F>>& v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
  [[nodiscard]] Vec3<ScalarOf<F>> get(size_t k) const { return {x[k], y[k], z[k]}; }
  [[nodiscard]] Vec3<F> load() const { return {x.load(), y.load(), z.load()}; }
  void store(const Vec3<F>& v) { x.store(v.x), y.store(v.y), z.store(v.z); }
};

template <class F>
struct RgbArray {
  LaneArray<F> r, g, b;

  void set(size_t k, const Rgb& c) { r[k] = c.r, g[k] = c.g, b[k] = c.b; }
  [[nodiscard]] Rgb get(size_t k) const { return {r[k], g[k], b[k]}; }
  [[nodiscard]] BasicRgb<F> load() const { return {r.load(), g.load(), b.load()}; }
  void store(const BasicRgb<F>& c) { r.store(c.r), g.store(c.g), b.store(c.b); }
};

/// The next larger float; of the largest, infinity. Finite numbers and -infinity only.
template <class F>
F next_up(const F& x) {
  using I = IntOf<F>;
  const I bits = std::bit_cast<I>(x);
  const I up = select(convert_mask<I>(x > F(0)), I(bits + I(1)), I(bits - I(1)));
  return select(x == F(0), F(std::numeric_limits<float>::denorm_min()), std::bit_cast<F>(up));
}

}  // namespace alhazen
