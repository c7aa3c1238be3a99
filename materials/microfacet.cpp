#include "materials/microfacet.h"

#include <array>
#include <numbers>

namespace alhazen {
namespace {

constexpr float kPi = std::numbers::pi_v<float>, kInvPi = std::numbers::inv_pi_v<float>;

float square(float x) { return x * x; }

/// ln of the visibility's shape, fitted by Estevez and Kulla (section 3).
float charlie_shape(float cos_theta, float alpha) {
  const float t = square(1 - alpha);
  const auto fit = [t](float rough, float smooth) { return rough + (smooth - rough) * t; };
  const float a = fit(21.5473f, 25.3245f), b = fit(3.82987f, 3.32435f), c = fit(0.19823f, 0.16801f);
  const float d = fit(-1.97760f, -1.27393f), e = fit(-4.32054f, -4.85967f);
  return a / (1 + b * std::pow(cos_theta, c)) + d * cos_theta + e;
}

float charlie_lambda(float cos_theta, float alpha) {
  if (cos_theta < 0.5f) return std::exp(charlie_shape(cos_theta, alpha));
  return std::exp(2 * charlie_shape(0.5f, alpha) - charlie_shape(1 - cos_theta, alpha));
}

// ---- Tables over roughness and cosine ----

template <class Value>
using Table = std::array<std::array<Value, kLobeTableSize>, kLobeTableSize>;  // by roughness, then cosine

template <class Value, class Integral>
Table<Value> tabulated(const Integral& integral) {
  Table<Value> table;
  for (int i = 0; i < kLobeTableSize; ++i)
    for (int k = 0; k < kLobeTableSize; ++k)
      table[size_t(i)][size_t(k)] =
          integral(float(i) / (kLobeTableSize - 1), std::max(1e-3f, float(k) / (kLobeTableSize - 1)));
  return table;
}

/// Midpoints of cells of the hemisphere of equal width in the square of the cosine and in azimuth (half of it: lobes
/// are symmetric): calls `visit(direction to the light, its share of the hemisphere's cosine-weighted measure)`.
template <class Visit>
void visit_hemisphere(const Visit& visit) {
  constexpr int kCosines = 24, kAzimuths = 16;
  for (int i = 0; i < kCosines; ++i)
    for (int k = 0; k < kAzimuths; ++k) {
      const float cos2 = (float(i) + 0.5f) / kCosines, cos_theta = std::sqrt(cos2), sin_theta = std::sqrt(1 - cos2);
      const float phi = kPi * (float(k) + 0.5f) / kAzimuths;
      visit(Vec3f{sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta}, kPi / (kCosines * kAzimuths));
    }
}

float integrate_charlie(float roughness, float cos_b) {
  const Vec3f b{std::sqrt(1 - cos_b * cos_b), 0, cos_b};
  float sum = 0;
  visit_hemisphere(
      [&](const Vec3f& s, float measure) { sum += measure * charlie(roughness, s.z, cos_b, normalize(s + b).z); });
  return std::min(sum, 1.0f);
}

/// By sampling the facets, (Karis 2013): cells of equal probability of the distribution.
SplitSum integrate_ggx(float roughness, float cos_b) {
  constexpr int kFacets = 32, kAzimuths = 8;
  const float alpha = std::max(1e-3f, roughness * roughness), a2 = alpha * alpha;
  const Vec3f b{std::sqrt(1 - cos_b * cos_b), 0, cos_b};
  const float stretched_b = std::sqrt(cos_b * cos_b * (1 - a2) + a2);
  SplitSum sum{0, 0};
  for (int i = 0; i < kFacets; ++i)
    for (int k = 0; k < kAzimuths; ++k) {
      const float u = (float(i) + 0.5f) / kFacets, phi = kPi * (float(k) + 0.5f) / kAzimuths;
      const float cos_h = std::sqrt((1 - u) / (1 + (a2 - 1) * u)), sin_h = std::sqrt(std::max(0.0f, 1 - cos_h * cos_h));
      const Vec3f h{sin_h * std::cos(phi), sin_h * std::sin(phi), cos_h};
      const float bh = dot(b, h);
      const Vec3f s = 2 * bh * h - b;
      if (!(s.z > 0 && bh > 0)) continue;
      // BRDF x cosine / probability = 4 visibility n·s b·h / n·h.
      const float visibility = smith_visibility(s.z, std::sqrt(s.z * s.z * (1 - a2) + a2), cos_b, stretched_b);
      const float weight = 4 * visibility * s.z * bh / cos_h / (kFacets * kAzimuths);
      const float schlick = std::pow(1 - bh, 5.0f);
      sum.scale += weight * (1 - schlick), sum.bias += weight * schlick;
    }
  return sum;
}

}  // namespace

ShadingFrame frame_about(const Vec3f& n) noexcept {
  const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

Alpha alpha_of(float roughness, float anisotropy) noexcept {
  const float alpha = std::max(1e-3f, roughness * roughness);
  return {alpha + (1 - alpha) * anisotropy * anisotropy, alpha};
}

float ggx(const Alpha& alpha, const ShadingFrame& frame, const Vec3f& s, const Vec3f& b, const Vec3f& h) noexcept {
  const float ns = dot(frame.n, s), nb = std::max(0.0f, dot(frame.n, b)), nh = dot(frame.n, h);
  if (!(ns > 0 && nh > 0)) return 0;
  if (alpha.t == alpha.b) return isotropic_ggx(alpha.t, ns, nb, frame.n, h);
  const auto stretched = [&](const Vec3f& w, float nw) {
    return std::sqrt(square(alpha.t * dot(frame.t, w)) + square(alpha.b * dot(frame.b, w)) + nw * nw);
  };
  const float area = alpha.t * alpha.b;
  const float q = square(alpha.b * dot(frame.t, h)) + square(alpha.t * dot(frame.b, h)) + square(area * nh);
  const float distribution = area * area * area * kInvPi / (q * q);
  return distribution * smith_visibility(ns, stretched(s, ns), nb, stretched(b, nb));
}

float charlie(float roughness, float n_dot_s, float n_dot_b, float n_dot_h) noexcept {
  if (!(n_dot_s > 0)) return 0;
  const float alpha = std::max(1e-3f, roughness * roughness), cos_b = std::max(1e-4f, n_dot_b);
  const float sin2 = std::max(0.0f, 1 - n_dot_h * n_dot_h);
  const float distribution = (2 + 1 / alpha) * std::pow(sin2, 0.5f / alpha) / (2 * kPi);
  const float visibility =
      1 / ((1 + charlie_lambda(n_dot_s, alpha) + charlie_lambda(cos_b, alpha)) * 4 * n_dot_s * cos_b);
  return distribution * std::min(visibility, 1.0f);
}

float charlie_albedo(float roughness, float cos_theta) noexcept {
  static const Table<float> table = tabulated<float>(integrate_charlie);
  float sum = 0;
  visit_lobe_table(roughness, cos_theta, [&](int entry, float weight) { sum += table.front().data()[entry] * weight; });
  return sum;
}

const float* ggx_albedo_table() noexcept {
  static const Table<SplitSum> table = tabulated<SplitSum>(integrate_ggx);
  return &table[0][0].scale;
}

}  // namespace alhazen
