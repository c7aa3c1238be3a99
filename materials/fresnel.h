// Reflection and refraction at a smooth boundary.
#pragma once

#include "core/lane_vec.h"

namespace alhazen {

/// Share of unpolarised light that a smooth dielectric boundary reflects, exact (Fresnel's equations).
/// cos_i >= 0 is the cosine on the incident side, eta = n1 / n2. 1 past the critical angle.
template <class F>
[[nodiscard]] F fresnel_dielectric(std::type_identity_t<F> cos_i, F eta) noexcept {
  const F ci = clamped(cos_i, 0, 1);
  const F sin2_t = eta * eta * (F(1) - ci * ci);
  const F ct = square_root(larger(F(1) - sin2_t, F(0)));
  const F s = (eta * ci - ct) / (eta * ci + ct);
  const F p = (eta * ct - ci) / (eta * ct + ci);
  return select(sin2_t < F(1), F(F(0.5f) * (s * s + p * p)), F(1));
}

/// The refracted direction eta d + (eta c - sqrt(1 - eta² (1 - c²))) n, c = -d·n >= 0, d and n unit length, n on d's
/// side. Returns false, and leaves `refracted` alone, past the critical angle.
template <class F>
[[nodiscard]] MaskOf<F> refract(const Vec3<F>& d, const Vec3<F>& n, std::type_identity_t<F> eta,
                                Vec3<F>& refracted) noexcept {
  const F c = clamped(F(-dot(d, n)), 0, 1);
  const F cos2_t = F(1) - eta * eta * (F(1) - c * c);
  const MaskOf<F> passes = cos2_t >= F(0);
  refracted = select(passes, eta * d + (eta * c - square_root(larger(cos2_t, F(0)))) * n, refracted);
  return passes;
}

/// Schlick's approximation f0 + (f90 - f0) (1 - cos)^5.
template <class F>
[[nodiscard]] BasicRgb<F> fresnel_schlick(const BasicRgb<F>& f0, std::type_identity_t<F> f90,
                                          std::type_identity_t<F> cos_theta) noexcept {
  const F m = F(1) - clamped(cos_theta, 0, 1);
  const F m2 = m * m;
  return lerp(f0, BasicRgb<F>(f90), m2 * m2 * m);
}

}  // namespace alhazen
