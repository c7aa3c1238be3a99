#include "exact/surd.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace alhazen {
namespace {

/// The sign of p + q sqrt(d).
int sign_of(const Rational& p, const Rational& q, const Rational& d) {
  const int sp = sgn(p), sq = sgn(d) == 0 ? 0 : sgn(q);
  if (sq == 0 || sp == sq) return sp != 0 ? sp : sq;
  if (sp == 0) return sq;
  const Rational difference = p * p - q * q * d;  // the larger square has the say
  return sp * sgn(difference);
}

/// x as binary128, truncated: its leading 113 bits.
Quad rational_to_quad(const Rational& x) {
  if (sgn(x) == 0) return 0;
  const mpz_class num = abs(x.get_num());
  const mpz_class& den = x.get_den();
  const long shift = 120 - long(mpz_sizeinbase(num.get_mpz_t(), 2)) + long(mpz_sizeinbase(den.get_mpz_t(), 2));
  mpz_class scaled = num;
  if (shift >= 0)
    scaled = (num << static_cast<unsigned long>(shift)) / den;
  else
    scaled = num / (den << static_cast<unsigned long>(-shift));
  Quad value = 0, weight = 1;
  for (mpz_class rest = scaled; rest != 0; rest >>= 32, weight *= Quad(0x1p32))
    value += weight * Quad(mpz_class(rest & mpz_class(0xffffffffu)).get_ui());
  for (long k = shift; k != 0;) {  // in steps that no exponent range objects to
    const int step = int(k > 1000 ? 1000 : k < -1000 ? -1000 : k);
    value *= Quad(std::ldexp(1.0, -step));
    k -= step;
  }
  return sgn(x) < 0 ? -value : value;
}

}  // namespace

int sign(const Surd& x) { return sign_of(x.p, x.q, x.radicand); }

int compare(const Surd& a, const Surd& b) {
  // The sign of x + r with x = (a.p - b.p) + a.q sqrt(a.radicand) and r = -b.q sqrt(b.radicand).
  const Rational p = a.p - b.p;
  if (a.radicand == b.radicand) return sign_of(p, a.q - b.q, a.radicand);
  const int sx = sign_of(p, a.q, a.radicand), sr = sgn(b.radicand) == 0 ? 0 : -sgn(b.q);
  if (sr == 0 || sx == sr) return sx != 0 ? sx : sr;
  if (sx == 0) return sr;
  // x² - r² = (p² + a.q² a.radicand - b.q² b.radicand) + 2 p a.q sqrt(a.radicand)
  const Rational rational = p * p + a.q * a.q * a.radicand - b.q * b.q * b.radicand;
  return sx * sign_of(rational, 2 * p * a.q, a.radicand);
}

Quad to_quad(const Surd& x) {
  if (sgn(x.q) == 0 || sgn(x.radicand) == 0) return rational_to_quad(x.p);
  const Quad root = rational_to_quad(x.q) * square_root(rational_to_quad(x.radicand));
  if (sgn(x.p) == 0 || sgn(x.p) == sgn(x.q)) return rational_to_quad(x.p) + root;
  // Opposite signs would cancel: multiply by the conjugate, p + q√d = (p² - q² d) / (p - q√d).
  const Rational norm = x.p * x.p - x.q * x.q * x.radicand;
  return rational_to_quad(norm) / (rational_to_quad(x.p) - root);
}

float to_float(const Surd& x) {
  const float inf = std::numeric_limits<float>::infinity();
  const float near = float(to_quad(x));
  if (std::isinf(near)) return near;
  // The float nearest to an approximation is nearest to x or next to it: compare x with the midpoints.
  const bool odd = std::bit_cast<uint32_t>(near) & 1;
  const auto passes = [&](float other, int side) {
    if (!std::isfinite(other)) return false;
    const int c = side * compare(x, Surd((exact(near) + exact(other)) / 2));
    return c > 0 || (c == 0 && odd);  // ties to even
  };
  const float up = std::nextafter(near, inf), down = std::nextafter(near, -inf);
  return passes(up, 1) ? up : passes(down, -1) ? down : near;
}

}  // namespace alhazen
