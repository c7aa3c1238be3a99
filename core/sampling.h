// Counter-based samples: a function of (pixel, sample) alone, so that no picture depends on who computed it.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "core/lane_vec.h"

namespace alhazen {

/// A bijective mixing of 32 bits (the "lowbias32" constants of C. Wellons' hash prospector).
template <class U = uint32_t>
[[nodiscard]] constexpr U mix_bits(std::type_identity_t<U> x) noexcept {
  x = (x ^ (x >> 16)) * U(0x7feb352du);
  x = (x ^ (x >> 15)) * U(0x846ca68bu);
  return x ^ (x >> 16);
}

template <class U>
[[nodiscard]] constexpr U reverse_bits(U x) noexcept {
  x = (x >> 16) | (x << 16);
  x = ((x & U(0x00ff00ffu)) << 8) | ((x & U(0xff00ff00u)) >> 8);
  x = ((x & U(0x0f0f0f0fu)) << 4) | ((x & U(0xf0f0f0f0u)) >> 4);
  x = ((x & U(0x33333333u)) << 2) | ((x & U(0xccccccccu)) >> 2);
  return ((x & U(0x55555555u)) << 1) | ((x & U(0xaaaaaaaau)) >> 1);
}

/// Nested uniform scrambling by hashing (Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020), of what comes
/// with its bits reversed.
template <class U>
[[nodiscard]] constexpr U owen_scramble_reversed(U x, std::type_identity_t<U> seed) noexcept {
  x += seed;
  x ^= x * U(0x6c50b47cu);
  x ^= x * U(0xb82f1e52u);
  x ^= x * U(0xc7afe638u);
  x ^= x * U(0x8d22f6e6u);
  return reverse_bits(x);
}
template <class U>
[[nodiscard]] constexpr U owen_scramble(U x, std::type_identity_t<U> seed) noexcept {
  return owen_scramble_reversed(reverse_bits(x), seed);
}

/// The bits times Pascal's triangle modulo 2: bit j is the sum of the bits k with C(k, j) odd, which are those whose
/// number has every 1 of j (Lucas' theorem).
template <class U>
[[nodiscard]] constexpr U pascal_product(U x) noexcept {
  x ^= (x & U(0xaaaaaaaau)) >> 1;
  x ^= (x & U(0xccccccccu)) >> 2;
  x ^= (x & U(0xf0f0f0f0u)) >> 4;
  x ^= (x & U(0xff00ff00u)) >> 8;
  return x ^ (x >> 16);
}

/// The upper 24 bits as a number in [0, 1).
template <class F = float>
[[nodiscard]] constexpr F unit_from_bits(const UintOf<F>& bits) noexcept {
  return convert<F>(UintOf<F>(bits >> 8)) * F(0x1p-24f);
}

/// Bits of point `index` of the scrambled (0, 2)-sequence of `seed`, as numbers (unit_from_bits) in [0, 1)²: any first
/// 2^k points are stratified in every elementary interval. The first two Sobol' dimensions. U: uint32_t, or lanes of
/// it.
template <class U>
[[nodiscard]] constexpr Vec2<U> sobol_owen_bits(U index, std::type_identity_t<U> seed) noexcept {
  const U i = owen_scramble(index, mix_bits<U>(seed));
  // The sequence is i, and i times Pascal's triangle, each with its bits reversed.
  return {owen_scramble_reversed(i, mix_bits<U>(seed + U(1))),
          owen_scramble_reversed(pascal_product(i), mix_bits<U>(seed + U(2)))};
}

[[nodiscard]] constexpr Vec2f sobol_owen(uint32_t index, uint32_t seed) noexcept {
  const Vec2<uint32_t> bits = sobol_owen_bits(index, seed);
  return {unit_from_bits(bits.x), unit_from_bits(bits.y)};
}

/// The direction numbers of the third Sobol' dimension: of the polynomial x^2 + x + 1, from 1 and 3 on.
inline constexpr std::array<uint32_t, 32> kThirdSobolDirections = [] {
  std::array<uint32_t, 32> v{1u << 31, 3u << 30};
  for (size_t k = 2; k < v.size(); ++k) v[k] = v[k - 1] ^ v[k - 2] ^ v[k - 2] >> 2;
  return v;
}();

/// The third coordinate of point `index` of the same sequence, in [0, 1).
[[nodiscard]] constexpr float third_sobol_owen(uint32_t index, uint32_t seed) noexcept {
  uint32_t i = owen_scramble(index, mix_bits(seed)), z = 0;
  for (size_t k = 0; i != 0; ++k, i >>= 1)
    if (i & 1) z ^= kThirdSobolDirections[k];
  return unit_from_bits(owen_scramble(z, mix_bits(seed + 3)));
}

/// A tent of half-width 1 about 0 from a uniform number: importance-sampling the reconstruction filter keeps every
/// sample in its own pixel's sum (Ernst, Stamminger, Greiner, Filter Importance Sampling, 2006).
template <class F = float>
[[nodiscard]] F sample_tent(std::type_identity_t<F> u) noexcept {
  return select(u < F(0.5f), F(square_root(F(F(2) * u)) - F(1)), F(F(1) - square_root(F(F(2) * (F(1) - u)))));
}

}  // namespace alhazen
