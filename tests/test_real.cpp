// Claims about core/real.h: lanes choose as single numbers do.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/real.h"

namespace alhazen {
namespace {

DoubleLanes random_lanes(std::mt19937& rng) {
  std::uniform_int_distribution<int> few(-2, 2);  // often equal
  return DoubleLanes([&](auto) { return double(few(rng)); });
}

TEST(DoubleLanes, ChooseLaneByLane) {
  std::mt19937 rng(81);
  for (int i = 0; i < 1000; ++i) {
    const DoubleLanes a = random_lanes(rng), b = random_lanes(rng), x = random_lanes(rng), y = random_lanes(rng);
    const DoubleLanes chosen = select(a < b, x, y), large = larger(a, b), small = smaller(a, b);
    for (size_t k = 0; k < DoubleLanes::size(); ++k) {
      ASSERT_EQ(chosen[k], a[k] < b[k] ? x[k] : y[k]);
      ASSERT_EQ(large[k], std::max<double>(a[k], b[k]));
      ASSERT_EQ(small[k], std::min<double>(a[k], b[k]));
    }
  }
}

TEST(DoubleLanes, MasksAreCombinedLaneByLane) {
  std::mt19937 rng(82);
  for (int i = 0; i < 1000; ++i) {
    const DoubleLanes a = random_lanes(rng), b = random_lanes(rng);
    const LaneMask less = a<b, positive = a> 0, differ = less != positive, neither = !(less || positive);
    bool any = false;
    for (size_t k = 0; k < DoubleLanes::size(); ++k) {
      ASSERT_EQ(bool(differ[k]), (a[k] < b[k]) != (a[k] > 0));
      ASSERT_EQ(bool(neither[k]), !(a[k] < b[k]) && !(a[k] > 0));
      any = any || a[k] < b[k];
    }
    ASSERT_EQ(any_of(less), any);
  }
}

}  // namespace
}  // namespace alhazen
