#include "materials/fresnel.h"

namespace alhazen {

float fresnel_dielectric(float cos_i, float eta) noexcept {
  const float ci = std::clamp(cos_i, 0.0f, 1.0f);
  const float sin2_t = eta * eta * (1 - ci * ci);
  if (!(sin2_t < 1)) return 1;
  const float ct = std::sqrt(1 - sin2_t);
  const float s = (eta * ci - ct) / (eta * ci + ct);
  const float p = (eta * ct - ci) / (eta * ct + ci);
  return 0.5f * (s * s + p * p);
}

bool refract(const Vec3f& d, const Vec3f& n, float eta, Vec3f& refracted) noexcept {
  const float c = std::clamp(-dot(d, n), 0.0f, 1.0f);
  const float cos2_t = 1 - eta * eta * (1 - c * c);
  if (!(cos2_t >= 0)) return false;
  refracted = eta * d + (eta * c - std::sqrt(cos2_t)) * n;
  return true;
}

}  // namespace alhazen
