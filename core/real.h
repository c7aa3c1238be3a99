// The number types that one closed form is written for: double, binary128 for the doubtful rays, and lanes of doubles
// for packets. Masks are bool for single numbers.
#pragma once

#include <cmath>
#include <experimental/simd>

#if defined __clang__ && defined __AVX512F__
#include <immintrin.h>
#endif

namespace alhazen {

__extension__ typedef __float128 Quad;  // IEEE binary128, in software

using DoubleLanes = std::experimental::native_simd<double>;
using LaneMask = DoubleLanes::mask_type;

/// Half the distance from 1 to the next number: the relative error of one rounding.
template <class T>
inline constexpr double kUnitRoundoff = 0x1p-53;
template <>
inline constexpr double kUnitRoundoff<Quad> = 0x1p-113;

inline bool any_of(bool mask) { return mask; }
inline bool any_of(const LaneMask& mask) { return std::experimental::any_of(mask); }

template <class T>
T select(bool mask, const T& yes, const T& no) {
  return mask ? yes : no;
}
inline DoubleLanes select(const LaneMask& mask, const DoubleLanes& yes, DoubleLanes no) {
#if defined __clang__ && defined __AVX512F__ && defined __GLIBCXX__
  // With clang, libstdc++'s where() takes all lanes or none here ("FIXME: this does a boolean choice, not a blend").
  const auto lanes = static_cast<__mmask8>(mask.__to_bitset().to_ulong());
  return DoubleLanes(_mm512_mask_blend_pd(lanes, static_cast<__m512d>(no), static_cast<__m512d>(yes)));
#else
  where(mask, no) = yes;
  return no;
#endif
}

inline double absolute(double x) { return std::abs(x); }
inline Quad absolute(Quad x) { return x < 0 ? -x : x; }
inline DoubleLanes absolute(const DoubleLanes& x) { return std::experimental::abs(x); }

inline double square_root(double x) { return std::sqrt(x); }
/// Two Newton steps from the double root; x >= 0. Error below 2 roundings.
inline Quad square_root(Quad x) {
  const double start = std::sqrt(double(x));
  if (!(start > 0) || !(start < HUGE_VAL)) return Quad(start);
  Quad y = Quad(start);
  for (int i = 0; i < 2; ++i) y = (y + x / y) / 2;
  return y;
}
inline DoubleLanes square_root(const DoubleLanes& x) { return std::experimental::sqrt(x); }

template <class T>
T larger(const T& a, const T& b) {
  return select(a > b, a, b);
}
template <class T>
T smaller(const T& a, const T& b) {
  return select(a < b, a, b);
}

}  // namespace alhazen
