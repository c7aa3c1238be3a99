// Claims about core/sampling.h: stratification, the filter's density, and samples that depend on nothing but their key.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/sampling.h"

namespace alhazen {
namespace {

/// Whether each of the 2^a x 2^b boxes that halve the square a times in x and b times in y holds one of the points.
bool one_in_each_box(const std::vector<Vec2f>& points, int a, int b) {
  std::vector<int> count(points.size());
  for (const Vec2f& p : points) ++count[(size_t(std::ldexp(p.x, a)) << b) + size_t(std::ldexp(p.y, b))];
  return std::all_of(count.begin(), count.end(), [](int n) { return n == 1; });
}

TEST(SobolOwen, EveryAlignedRunOf2ToTheKPointsIsStratifiedInAllElementaryIntervals) {
  std::mt19937 rng(71);
  for (int trial = 0; trial < 200; ++trial) {
    const uint32_t seed = rng();
    const int k = trial % 11;
    const uint32_t first = (trial % 2 ? rng() % 64 : 0) << k;
    std::vector<Vec2f> points;
    for (uint32_t i = 0; i < 1u << k; ++i) points.push_back(sobol_owen(first + i, seed));
    for (int a = 0; a <= k; ++a) ASSERT_TRUE(one_in_each_box(points, a, k - a)) << "seed " << seed << " k " << k;
  }
}

TEST(SobolOwen, ItsThirdCoordinateIsStratifiedAsTheOthersAre) {
  for (uint32_t seed = 0; seed < 20; ++seed)
    for (uint32_t k = 0; k < 9; ++k)
      for (uint32_t first : {0u, 1u << k, 6u << k}) {
        std::vector<int> strata(1u << k);
        for (uint32_t i = 0; i < 1u << k; ++i) {
          const float z = third_sobol_owen(first + i, seed);
          ASSERT_TRUE(z >= 0 && z < 1);
          ++strata[size_t(z * float(1u << k))];
        }
        for (const int count : strata) EXPECT_EQ(count, 1);
      }
}

TEST(SobolOwen, ItsThirdCoordinateKnowsNothingOfTheFirstTwo) {
  // Of the first points of many seeds, and of many points of one seed.
  const auto correlation = [](const auto& index, const auto& seed, bool of_y) {
    constexpr uint32_t kCount = 4096;
    double sum = 0;
    for (uint32_t i = 0; i < kCount; ++i) {
      const Vec2f p = sobol_owen(index(i), seed(i));
      sum += (double(of_y ? p.y : p.x) - 0.5) * (double(third_sobol_owen(index(i), seed(i))) - 0.5);
    }
    return 12 * sum / kCount;
  };
  const auto zero = [](uint32_t) { return 0u; };
  const auto each = [](uint32_t i) { return i; };
  const auto mixed = [](uint32_t i) { return mix_bits(i); };
  for (const bool of_y : {false, true}) {
    EXPECT_NEAR(correlation(zero, mixed, of_y), 0, 0.06);
    EXPECT_NEAR(correlation(each, zero, of_y), 0, 0.01);
  }
}

TEST(SobolOwen, LiesInTheHalfOpenUnitSquare) {
  std::mt19937 rng(72);
  for (int i = 0; i < 100000; ++i) {
    const Vec2f p = sobol_owen(rng(), rng());
    ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1) << p.x << " " << p.y;
  }
}

TEST(SobolOwen, IsAFunctionOfIndexAndSeedAlone) {
  std::vector<Vec2f> forward, backward;
  for (uint32_t i = 0; i < 256; ++i) forward.push_back(sobol_owen(i, 1234));
  for (uint32_t i = 256; i-- > 0;) {
    (void)sobol_owen(i, 99);
    backward.insert(backward.begin(), sobol_owen(i, 1234));
  }
  for (size_t i = 0; i < 256; ++i) EXPECT_TRUE(forward[i].x == backward[i].x && forward[i].y == backward[i].y);
  static_assert(sobol_owen(5, 7).x == sobol_owen(5, 7).x);  // no state, no machine: known when compiled
}

TEST(SobolOwen, FirstPointsOfDifferentSeedsAreUniformAndNotCorrelated) {
  // 2^16 seeds in a row, as pixels in a row have them. Chi-square over 16 x 16 boxes: mean 255, deviation sqrt(510);
  // within six of them.
  constexpr int kSeeds = 1 << 16, kSide = 16;
  for (const uint32_t index : {0u, 1u, 5u}) {
    std::vector<double> boxes(kSide * kSide);
    double correlation = 0;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
      const Vec2f p = sobol_owen(index, seed), next = sobol_owen(index, seed + 1);
      ++boxes[size_t(p.x * kSide) * kSide + size_t(p.y * kSide)];
      correlation += (double(p.x) - 0.5) * (double(next.x) - 0.5) + (double(p.y) - 0.5) * (double(next.y) - 0.5);
    }
    const double mean = double(kSeeds) / (kSide * kSide);
    double chi_square = 0;
    for (const double n : boxes) chi_square += (n - mean) * (n - mean) / mean;
    EXPECT_NEAR(chi_square, 255, 6 * std::sqrt(510.0)) << "point " << index;
    // Each product has deviation 1/12, and there are 2 kSeeds of them.
    EXPECT_LE(std::abs(correlation), 6 * std::sqrt(2.0 * kSeeds) / 12) << "point " << index;
  }
}

TEST(MixBits, MapsDistinctNumbersToDistinctOnes) {
  // Of 2^20 numbers a random map of 32 bits would bring 128 pairs together.
  std::vector<uint32_t> mixed;
  for (uint32_t i = 0; i < 1u << 20; ++i) mixed.push_back(mix_bits(i * 4097));
  std::sort(mixed.begin(), mixed.end());
  EXPECT_EQ(std::adjacent_find(mixed.begin(), mixed.end()), mixed.end());
}

TEST(ReverseBits, IsItsOwnInverseAndSwapsTheEnds) {
  std::mt19937 rng(73);
  for (int i = 0; i < 10000; ++i) {
    const uint32_t x = rng();
    ASSERT_EQ(reverse_bits(reverse_bits(x)), x);
  }
  for (int bit = 0; bit < 32; ++bit) EXPECT_EQ(reverse_bits(1u << bit), 1u << (31 - bit));
}

TEST(OwenScramble, KeepsNestedIntervalsTogether) {
  // Numbers with the same k leading bits keep that in common: elementary intervals are permuted, not torn.
  std::mt19937 rng(74);
  for (int i = 0; i < 10000; ++i) {
    const uint32_t x = rng(), seed = rng(), k = 1 + rng() % 31, low = ~0u >> k;
    const uint32_t other = (x & ~low) | (rng() & low);
    ASSERT_EQ(owen_scramble(x, seed) >> (32 - k), owen_scramble(other, seed) >> (32 - k));
    ASSERT_NE(owen_scramble(x, seed), owen_scramble(x ^ (1u << (32 - k)), seed));
  }
}

TEST(SampleTent, InvertsTheDistributionOfTheTent) {
  // P(X <= x) = (1 + x)²/2 below 0, 1 - (1 - x)²/2 above.
  const auto probability = [](double x) { return x < 0 ? (1 + x) * (1 + x) / 2 : 1 - (1 - x) * (1 - x) / 2; };
  for (int i = 0; i < 1 << 16; ++i) {
    const float u = std::ldexp(float(i) + 0.5f, -16), x = sample_tent(u);
    ASSERT_NEAR(probability(double(x)), double(u), 2e-7);
  }
}

TEST(SampleTent, GrowsWithItsArgumentAndIsOdd) {
  EXPECT_EQ(sample_tent(0), -1);
  EXPECT_EQ(sample_tent(0.5f), 0);
  float previous = -1;
  for (int i = 0; i <= 1 << 16; ++i) {
    const float u = std::ldexp(float(i), -16), x = sample_tent(u);
    ASSERT_TRUE(x >= previous && x <= 1) << u;
    ASSERT_NEAR(x, -sample_tent(1 - u), 1e-7f);
    previous = x;
  }
}

}  // namespace
}  // namespace alhazen
