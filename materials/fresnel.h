// Reflection and refraction at a smooth boundary.
#pragma once

#include "core/vec.h"

namespace alhazen {

/// Share of unpolarised light that a smooth dielectric boundary reflects, exact (Fresnel's equations).
/// cos_i >= 0 is the cosine on the incident side, eta = n1 / n2. 1 past the critical angle.
[[nodiscard]] float fresnel_dielectric(float cos_i, float eta) noexcept;

/// The refracted direction eta d + (eta c - sqrt(1 - eta² (1 - c²))) n, c = -d·n >= 0, d and n unit length, n on d's
/// side. Returns false, and leaves `refracted` alone, past the critical angle.
[[nodiscard]] bool refract(const Vec3f& d, const Vec3f& n, float eta, Vec3f& refracted) noexcept;

/// Schlick's approximation f0 + (f90 - f0) (1 - cos)^5.
[[nodiscard]] inline Rgb fresnel_schlick(const Rgb& f0, float f90, float cos_theta) noexcept {
  const float m = 1 - std::clamp(cos_theta, 0.0f, 1.0f);
  const float m2 = m * m;
  return lerp(f0, Rgb{f90}, m2 * m2 * m);
}

}  // namespace alhazen
