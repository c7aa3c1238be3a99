// Powers written once for floats and lanes of them: polynomials of S. Moshier's Cephes library (log2f, exp2f).
#pragma once

#include <bit>

#include "core/lane_vec.h"

namespace alhazen {

/// x^exponent for x in (0, 1] and an exponent of 0 and more; 0 where that is below 2^-126.
///
/// accuracy  relative, off by at most 2e-7 (1 + |log2 of the result|): as x^exponent fades its last digits do.
template <class F>
[[nodiscard]] F power(const F& x, const F& exponent) {
  using I = IntOf<F>;
  // x = m 2^e, m about 1
  const I bits = std::bit_cast<I>(x);
  const F in_1_to_2 = std::bit_cast<F>(I((bits & I(0x7FFFFF)) | I(0x3F800000)));
  const MaskOf<F> halve = in_1_to_2 > F(1.41421356f);
  const F e = convert<F>(I((bits >> 23) - I(127))) + select(halve, F(1), F(0));
  const F f = select(halve, F(F(0.5f) * in_1_to_2), in_1_to_2) - F(1), z = f * f;
  const F p =
      (((((((F(7.0376836292e-2f) * f - F(1.1514610310e-1f)) * f + F(1.1676998740e-1f)) * f - F(1.2420140846e-1f)) * f +
          F(1.4249322787e-1f)) *
             f -
         F(1.6668057665e-1f)) *
            f +
        F(2.0000714765e-1f)) *
           f -
       F(2.4999993993e-1f)) *
          f +
      F(3.3333331174e-1f);
  const F curved = f * z * p - F(0.5f) * z;  // ln m - f
  constexpr float kLog2OfELess1 = 0.44269504088896341f;
  const F log2_x = curved * F(kLog2OfELess1) + f * F(kLog2OfELess1) + curved + f + e;

  const F result = larger(F(log2_x * exponent), F(-127));  // not above 0
  const I whole = convert<I>(F(result - F(0.5f)));
  const F g = result - convert<F>(whole);
  const F q = ((((F(1.535336188319500e-4f) * g + F(1.339887440266574e-3f)) * g + F(9.618437357674640e-3f)) * g +
                F(5.550332471162809e-2f)) *
                   g +
               F(2.402264791363012e-1f)) *
                  g +
              F(6.931472028550421e-1f);
  const F scale = std::bit_cast<F>(I((whole + I(127)) << 23));
  return select(result < F(-126), F(0), F((F(1) + g * q) * scale));
}

}  // namespace alhazen
