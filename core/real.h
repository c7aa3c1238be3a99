// The number types that one closed form is written for: double, binary128 for the doubtful rays, lanes of doubles for
// packets, and lanes of floats for what can be told at a glance. Masks are bool for single numbers.
#pragma once

#include <cmath>
#include <cstdint>
#include <experimental/simd>

#if defined __clang__ && defined __AVX512F__
#include <immintrin.h>
#endif

namespace alhazen {

__extension__ typedef __float128 Quad;  // IEEE binary128, in software

template <class N, int n>
using LanesOf = std::experimental::simd<N, std::experimental::simd_abi::deduce_t<N, n>>;
template <int n>
using FloatLanes = LanesOf<float, n>;
using DoubleLanes = std::experimental::native_simd<double>;
using LaneMask = DoubleLanes::mask_type;

template <class T>
concept IsLanes = std::experimental::is_simd_v<T>;

namespace real_detail {
template <class T>
struct Traits {
  using Scalar = T;
  using Mask = bool;
};
template <IsLanes T>
struct Traits<T> {
  using Scalar = typename T::value_type;
  using Mask = typename T::mask_type;
};
}  // namespace real_detail

/// What one lane of T is made of; what comparing two T gives.
template <class T>
using ScalarOf = typename real_detail::Traits<T>::Scalar;
template <class T>
using MaskOf = typename real_detail::Traits<T>::Mask;

/// Half the distance from 1 to the next number: the relative error of one rounding.
template <class T>
inline constexpr double kUnitRoundoff = 0x1p-53;
template <>
inline constexpr double kUnitRoundoff<Quad> = 0x1p-113;
template <IsLanes T>
inline constexpr double kUnitRoundoff<T> = kUnitRoundoff<ScalarOf<T>>;
template <>
inline constexpr double kUnitRoundoff<float> = 0x1p-24;

inline bool any_of(bool mask) { return mask; }  // of lanes: std::experimental::any_of

/// Bit k: lane k of the mask.
template <class T, class Abi>
uint32_t lane_bits(const std::experimental::simd_mask<T, Abi>& mask) {
#ifdef __GLIBCXX__
  return uint32_t(mask.__to_bitset().to_ulong());
#else
  uint32_t bits = 0;
  for (size_t k = 0; k < mask.size(); ++k) bits |= uint32_t(mask[k]) << k;
  return bits;
#endif
}

template <class T>
T select(bool mask, const T& yes, const T& no) {
  return mask ? yes : no;
}
template <IsLanes T>
T select(const MaskOf<T>& mask, const T& yes, T no) {
#if defined __clang__ && defined __AVX512F__ && defined __GLIBCXX__
  // With clang, libstdc++'s where() takes all lanes or none here ("FIXME: this does a boolean choice, not a blend").
  if constexpr (sizeof(T) == sizeof(__m512d) && std::is_same_v<ScalarOf<T>, double>)
    return T(_mm512_mask_blend_pd(__mmask8(lane_bits(mask)), static_cast<__m512d>(no), static_cast<__m512d>(yes)));
  if constexpr (sizeof(T) == sizeof(__m512) && std::is_same_v<ScalarOf<T>, float>)
    return T(_mm512_mask_blend_ps(__mmask16(lane_bits(mask)), static_cast<__m512>(no), static_cast<__m512>(yes)));
  if constexpr (sizeof(T) >= sizeof(__m512)) return T([&](auto k) { return mask[k] ? yes[k] : no[k]; });
#endif
  where(mask, no) = yes;
  return no;
}

inline double absolute(double x) { return std::abs(x); }
inline Quad absolute(Quad x) { return x < 0 ? -x : x; }
template <IsLanes T>
T absolute(const T& x) {
  return std::experimental::abs(x);
}

inline double square_root(double x) { return std::sqrt(x); }
/// Two Newton steps from the double root; x >= 0. Error below 2 roundings.
inline Quad square_root(Quad x) {
  const double start = std::sqrt(double(x));
  if (!(start > 0) || !(start < HUGE_VAL)) return Quad(start);
  Quad y = Quad(start);
  for (int i = 0; i < 2; ++i) y = (y + x / y) / 2;
  return y;
}
template <IsLanes T>
T square_root(const T& x) {
  return std::experimental::sqrt(x);
}

template <class T>
T larger(const T& a, const T& b) {
  return select(a > b, a, b);
}
template <class T>
T smaller(const T& a, const T& b) {
  return select(a < b, a, b);
}

}  // namespace alhazen
