// Numbers known to lie in an interval, the judge's arithmetic: a midpoint, double or double-double, and a radius that
// every operation keeps honest by itself, so that no error analysis by hand, and none of the intersectors', is relied
// upon.
//
// A sign that the radius leaves open throws `InDoubt`: the whole question then goes to the wider midpoint, and from
// there to rational numbers, as in filtered predicates (Brönnimann, Burnikel, Pion, Interval Arithmetic Yields
// Efficient Dynamic Filters, 2001).
#pragma once

#include <gmpxx.h>

#include "core/real.h"
#include "crosscheck/double_double.h"

namespace alhazen::crosscheck {

struct InDoubt {};

/// The number lies within [mid - rad, mid + rad]. N is double or DoubleDouble.
template <class N>
struct Ball {
  N mid = 0;
  double rad = 0;

  Ball() = default;
  Ball(double exactly) : mid(exactly) {}  // NOLINT: every double is a ball
  Ball(N middle, double radius) : mid(middle), rad(radius) {}
  explicit Ball(const Rational& x) {
    if (sgn(x) == 0) return;
    mid = nearly(x, N());
    rad = size() * (32 * kUnitRoundoff<N>)+kUnderflow;
  }

  [[nodiscard]] double size() const { return double(absolute(mid)) * (1 + 0x1p-50); }
  [[nodiscard]] bool is_zero() const { return mid == 0 && rad == 0; }

  friend Ball operator-(const Ball& a) { return {-a.mid, a.rad}; }
  friend Ball operator+(const Ball& a, const Ball& b) {
    if (a.is_zero()) return b;
    if (b.is_zero()) return a;
    const N sum = a.mid + b.mid;
    // A difference of equal exact numbers is exact.
    return sum == 0 && a.rad == 0 && b.rad == 0 ? Ball() : rounded(sum, a.rad + b.rad);
  }
  friend Ball operator-(const Ball& a, const Ball& b) { return a + (-b); }
  friend Ball operator*(const Ball& a, const Ball& b) {
    if (a.is_zero() || b.is_zero()) return {};
    return rounded(a.mid * b.mid, a.size() * b.rad + b.size() * a.rad + a.rad * b.rad);
  }
  friend Ball operator/(const Ball& a, const Ball& b) {
    const double least = double(absolute(b.mid)) * (1 - 0x1p-50) - b.rad;
    if (!(least > kTiny)) throw InDoubt();
    if (a.is_zero()) return {};
    const N quotient = a.mid / b.mid;
    return rounded(quotient, (a.rad + double(absolute(quotient)) * (1 + 0x1p-50) * b.rad) / least);
  }

  /// x > 0 for certain.
  friend Ball square_root(const Ball& x) {
    const double least = double(x.mid) * (1 - 0x1p-50) - x.rad;
    if (!(least > kTiny)) throw InDoubt();
    return rounded(root_of(x.mid), x.rad / std::sqrt(least));
  }

  /// -1, 0 or 1 if that is certain, else throws InDoubt; NaN is never certain.
  friend int sign(const Ball& x) {
    if (x.mid > N(x.rad)) return 1;
    if (x.mid < -N(x.rad)) return -1;
    if (x.is_zero()) return 0;
    throw InDoubt();
  }

  /// The nearest float, if one is nearest for certain.
  friend float to_float(const Ball& x) {
    const N margin(x.rad + x.size() * (2 * kUnitRoundoff<N>));  // the sums are rounded
    const auto lower = float(x.mid - margin), upper = float(x.mid + margin);
    if (!(lower == upper)) throw InDoubt();
    return lower;
  }

 private:
  static constexpr double kUnderflow = 0x1p-1000;  // more than any operation loses below the range of double
  static constexpr double kTiny = 0x1p-500;        // what is divided by numbers so small is in doubt

  static N root_of(const N& x) {
    using alhazen::square_root;
    return square_root(x);  // found by the argument's type
  }
  static double nearly(const Rational& x, double) { return x.get_d(); }
  static DoubleDouble nearly(const Rational& x, DoubleDouble) { return to_double_double(x); }

  /// `rad` is off by the roundings of this very computation, which the factor covers.
  static Ball rounded(N mid, double rad) {
    const double rounding = double(absolute(mid)) * (2 * kUnitRoundoff<N>);
    return {mid, (rad + rounding + kUnderflow) * (1 + 0x1p-40)};
  }
};

}  // namespace alhazen::crosscheck
