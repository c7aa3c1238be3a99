// Numbers of about 106 bits as sums of two doubles: as wide as the judge needs, many times as fast as binary128 in
// software, and no arithmetic of the intersectors'.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/real.h"
#include "exact/surd.h"

namespace alhazen::crosscheck {

/// hi + lo, hi being the double nearest to it.
///
/// accuracy  sums, products, quotients and square roots within a relative 2^-102, while nothing under- or overflows.
/// source    Joldes, Muller, Popescu, Tight and Rigorous Error Bounds for Basic Building Blocks of Double-Word
///           Arithmetic, ACM TOMS 44(2), 2017: algorithms 6 (3 u² + 13 u³), 12 (5 u²) and 17 (15 u² + 56 u³).
struct DoubleDouble {
  double hi = 0, lo = 0;

  DoubleDouble() = default;
  DoubleDouble(double x) : hi(x) {}  // NOLINT: every double is one
  DoubleDouble(double high, double low) : hi(high), lo(low) {}

  explicit operator double() const { return hi; }
  /// Correctly rounded: the double is first rounded to odd, so that no second rounding meets a tie that is none.
  explicit operator float() const {
    if (lo == 0 || std::bit_cast<uint64_t>(hi) & 1) return float(hi);
    return float(std::nextafter(hi, std::copysign(HUGE_VAL, lo)));
  }

  friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }
  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = sum(a.hi, b.hi), t = sum(a.lo, b.lo), v = ordered_sum(s.hi, s.lo + t.hi);
    return ordered_sum(v.hi, t.lo + v.lo);
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble p = product(a.hi, b.hi);
    return ordered_sum(p.hi, p.lo + std::fma(a.lo, b.hi, std::fma(a.hi, b.lo, a.lo * b.lo)));
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double q = a.hi / b.hi;
    const DoubleDouble rest = a - DoubleDouble(q) * b;
    return ordered_sum(q, rest.hi / b.hi);
  }
  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
  }
  friend bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
  friend bool operator==(const DoubleDouble& a, const DoubleDouble& b) { return a.hi == b.hi && a.lo == b.lo; }

  /// x >= 0: one Newton step from the double root.
  friend DoubleDouble square_root(const DoubleDouble& x) {
    const double root = std::sqrt(x.hi);
    if (!(root > 0)) return root;
    const DoubleDouble rest = x - product(root, root);
    return ordered_sum(root, rest.hi / (2 * root));
  }
  friend DoubleDouble absolute(const DoubleDouble& x) { return x.hi < 0 ? -x : x; }

 private:
  static DoubleDouble ordered_sum(double a, double b) {  // |a| >= |b|
    const double s = a + b;
    return {s, b - (s - a)};
  }
  static DoubleDouble sum(double a, double b) {
    const double s = a + b, of_b = s - a;
    return {s, (a - (s - of_b)) + (b - of_b)};
  }
  static DoubleDouble product(double a, double b) {
    const double p = a * b;
    return {p, std::fma(a, b, -p)};
  }
};

/// Within a relative 2^-102.
[[nodiscard]] inline DoubleDouble to_double_double(const Rational& x) {
  const double high = x.get_d();  // truncated
  const Rational rest = x - Rational(high);
  return DoubleDouble(high) + DoubleDouble(rest.get_d());
}

}  // namespace alhazen::crosscheck

namespace alhazen {
template <>
inline constexpr double kUnitRoundoff<crosscheck::DoubleDouble> = 0x1p-102;
}  // namespace alhazen
