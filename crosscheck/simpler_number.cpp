#include "crosscheck/simpler_number.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace alhazen::crosscheck {
namespace {

constexpr int kOfOne = 4, kOfABit = 8, kOfNaN = 10000;
constexpr int kDoubleBits = 53;

/// Of the significand, up to its last 1.
int significant_bits(double x) {
  int exponent;
  auto whole = uint64_t(std::ldexp(std::frexp(std::abs(x), &exponent), kDoubleBits));
  int bits = kDoubleBits;
  for (; bits > 1 && (whole & 1) == 0; whole >>= 1) --bits;
  return bits;
}

/// Towards 0, or away from it.
double rounded_to_bits(double x, int bits, bool away) {
  const double step = std::ldexp(1.0, std::ilogb(x) + 1 - bits);
  const double down = std::trunc(x / step) * step;
  return away && down != x ? down + std::copysign(step, x) : down;
}

}  // namespace

int complexity(double x) {
  if (std::isnan(x)) return kOfNaN;
  const int sign = std::signbit(x);
  if (x == 0) return sign;
  if (std::isinf(x)) return kOfOne + sign;
  return kOfOne + kOfABit * (significant_bits(x) - 1) + std::abs(std::ilogb(x)) + sign;
}

std::vector<double> simpler_numbers(double x, bool may_be_infinite) {
  std::vector<double> list{0, 1, -1};
  if (may_be_infinite) list.push_back(std::numeric_limits<double>::infinity());
  if (std::isfinite(x) && x != 0) {
    const int exponent = std::ilogb(x);
    list.push_back(-x);
    for (const int shift : {exponent, exponent / 2, exponent < 0 ? -1 : 1}) list.push_back(std::ldexp(x, -shift));
    for (int bits = 1; bits < significant_bits(x); ++bits)
      for (const bool away : {false, true}) list.push_back(rounded_to_bits(x, bits, away));
  }
  std::erase_if(list, [&](double simpler) { return complexity(simpler) >= complexity(x); });
  std::stable_sort(list.begin(), list.end(), [](double a, double b) { return complexity(a) < complexity(b); });
  return list;
}

}  // namespace alhazen::crosscheck
