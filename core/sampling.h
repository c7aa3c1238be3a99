// Counter-based samples: a function of (pixel, sample) alone, so that no picture depends on who computed it.
#pragma once

#include <array>
#include <cstdint>

#include "core/vec.h"

namespace alhazen {

/// A bijective mixing of 32 bits (the "lowbias32" constants of C. Wellons' hash prospector).
[[nodiscard]] constexpr uint32_t mix_bits(uint32_t x) noexcept {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

[[nodiscard]] constexpr uint32_t reverse_bits(uint32_t x) noexcept {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Nested uniform scrambling by hashing (Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020).
[[nodiscard]] constexpr uint32_t owen_scramble(uint32_t x, uint32_t seed) noexcept {
  x = reverse_bits(x) + seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverse_bits(x);
}

/// The bits times Pascal's triangle modulo 2: bit j is the sum of the bits k with C(k, j) odd, which are those whose
/// number has every 1 of j (Lucas' theorem).
[[nodiscard]] constexpr uint32_t pascal_product(uint32_t x) noexcept {
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  return x ^ x >> 16;
}

/// Point `index` of the scrambled (0, 2)-sequence of `seed`, in [0, 1)²: any first 2^k points are stratified in every
/// elementary interval. The first two Sobol' dimensions.
[[nodiscard]] constexpr Vec2f sobol_owen(uint32_t index, uint32_t seed) noexcept {
  const uint32_t i = owen_scramble(index, mix_bits(seed));
  const uint32_t y = reverse_bits(pascal_product(i));
  const auto unit = [](uint32_t bits) { return float(bits >> 8) * 0x1p-24f; };
  return {unit(owen_scramble(reverse_bits(i), mix_bits(seed + 1))), unit(owen_scramble(y, mix_bits(seed + 2)))};
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
  return float(owen_scramble(z, mix_bits(seed + 3)) >> 8) * 0x1p-24f;
}

/// A tent of half-width 1 about 0 from a uniform number: importance-sampling the reconstruction filter keeps every
/// sample in its own pixel's sum (Ernst, Stamminger, Greiner, Filter Importance Sampling, 2006).
[[nodiscard]] inline float sample_tent(float u) noexcept {
  return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u));
}

}  // namespace alhazen
