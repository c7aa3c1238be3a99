// Numbers known to lie in an interval, the judge's arithmetic: a binary128 midpoint and a radius that every operation
// keeps honest by itself, so that no error analysis by hand, and none of the intersectors', is relied upon.
//
// A sign that the radius leaves open throws `InDoubt`: the whole question then goes to rational numbers, as in filtered
// predicates (Brönnimann, Burnikel, Pion, Interval Arithmetic Yields Efficient Dynamic Filters, 2001).
#pragma once

#include <gmpxx.h>

#include "core/real.h"
#include "exact/surd.h"

namespace alhazen::crosscheck {

struct InDoubt {};

/// The number lies within [mid - rad, mid + rad].
struct Ball {
  Quad mid = 0;
  double rad = 0;

  Ball() = default;
  Ball(double exactly) : mid(exactly) {}  // NOLINT: every double is a ball
  Ball(Quad middle, double radius) : mid(middle), rad(radius) {}
  explicit Ball(const Rational& x) : mid(to_quad(Surd(x))), rad(size() * 0x1p-108) {}

  [[nodiscard]] double size() const { return double(absolute(mid)) * (1 + 0x1p-50); }
  [[nodiscard]] bool is_zero() const { return mid == 0 && rad == 0; }
};

namespace ball_detail {
/// `rad` is off by the roundings of this very computation, which the factor covers.
inline Ball rounded(Quad mid, double rad) { return {mid, (rad + double(absolute(mid)) * 0x1p-112) * (1 + 0x1p-40)}; }
}  // namespace ball_detail

inline Ball operator-(const Ball& a) { return {-a.mid, a.rad}; }
inline Ball operator+(const Ball& a, const Ball& b) {
  if (a.is_zero()) return b;
  if (b.is_zero()) return a;
  const Quad mid = a.mid + b.mid;
  // A difference of equal exact numbers is exact.
  return mid == 0 && a.rad == 0 && b.rad == 0 ? Ball() : ball_detail::rounded(mid, a.rad + b.rad);
}
inline Ball operator-(const Ball& a, const Ball& b) { return a + (-b); }
inline Ball operator*(const Ball& a, const Ball& b) {
  if (a.is_zero() || b.is_zero()) return {};
  return ball_detail::rounded(a.mid * b.mid, a.size() * b.rad + b.size() * a.rad + a.rad * b.rad);
}
inline Ball operator/(const Ball& a, const Ball& b) {
  const double least = double(absolute(b.mid)) * (1 - 0x1p-50) - b.rad;
  if (!(least > 0)) throw InDoubt();
  const Quad mid = a.mid / b.mid;
  return ball_detail::rounded(mid, (a.rad + double(absolute(mid)) * (1 + 0x1p-50) * b.rad) / least);
}

/// -1, 0 or 1 if that is certain, else throws InDoubt; NaN is never certain.
inline int sign(const Ball& x) {
  if (x.mid > Quad(x.rad)) return 1;
  if (x.mid < -Quad(x.rad)) return -1;
  if (x.is_zero()) return 0;
  throw InDoubt();
}

/// x > 0 for certain.
inline Ball square_root(const Ball& x) {
  const double least = double(x.mid) * (1 - 0x1p-50) - x.rad;
  if (!(least > 0)) throw InDoubt();
  return ball_detail::rounded(alhazen::square_root(x.mid), x.rad / std::sqrt(least));
}

/// The nearest float, if one is nearest for certain.
inline float to_float(const Ball& x) {
  const auto lower = float(x.mid - Quad(x.rad)), upper = float(x.mid + Quad(x.rad));
  if (!(lower == upper)) throw InDoubt();
  return lower;
}

}  // namespace alhazen::crosscheck
