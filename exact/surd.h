// Exact arithmetic for what floating point cannot decide: rational numbers, and the roots of quadratics over them.
#pragma once

#include <gmpxx.h>

#include "core/real.h"
#include "core/vec.h"

namespace alhazen {

using Rational = mpq_class;

/// p + q sqrt(radicand), radicand >= 0.
struct Surd {
  Rational p, q, radicand;

  Surd() = default;
  Surd(Rational rational) : p(std::move(rational)) {}  // NOLINT: a rational number is a surd
  Surd(Rational p_, Rational q_, Rational radicand_)
      : p(std::move(p_)), q(std::move(q_)), radicand(std::move(radicand_)) {}
};

/// -1, 0 or 1. Exact.
[[nodiscard]] int sign(const Surd& x);

/// The sign of a - b. Exact, also for different radicands: by squaring twice.
[[nodiscard]] int compare(const Surd& a, const Surd& b);

/// The nearest binary128 up to a relative error of 2^-110.
[[nodiscard]] Quad to_quad(const Surd& x);

/// Correctly rounded to nearest, ties to even; overflow gives infinity. Exact.
[[nodiscard]] float to_float(const Surd& x);

/// The exact value of a finite number.
[[nodiscard]] inline Rational exact(double x) { return Rational(x); }
[[nodiscard]] inline Vec3<Rational> exact(const Vec3d& v) { return {Rational(v.x), Rational(v.y), Rational(v.z)}; }

/// The points origin + t direction, exactly.
struct ExactLine {
  Vec3<Rational> origin, direction;
};

}  // namespace alhazen
