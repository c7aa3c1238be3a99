#include "materials/thin_film.h"

#include <numbers>

#include "materials/fresnel.h"

namespace alhazen {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kAir = 1;

float square(float x) { return x * x; }
float f0_of(float ior_to, float ior_from) { return square((ior_to - ior_from) / (ior_to + ior_from)); }
float ior_of(float f0) {
  const float root = std::sqrt(std::min(f0, 0.9999f));
  return (1 + root) / (1 - root);
}
float schlick(float f0, float cos_theta) { return fresnel_schlick(Rgb{f0}, 1, cos_theta).r; }

float smoothstep(float end, float x) {
  const float t = std::min(std::max(x / end, 0.0f), 1.0f);
  return t * t * (3 - 2 * t);
}

struct Xyz {
  float x, y, z;
};

/// How the eye sees light that has an optical path difference (metres) and a phase shift: the Fourier transform of
/// Gaussians fitted to the CIE 1931 colour matching functions (Belcour and Barla, supplement).
Xyz sensitivity(float path_difference, const Rgb& shift) {
  constexpr float kNorm = 1.0685e-7f;
  const float phase = 2 * kPi * path_difference;
  const auto gaussian = [phase](float height, float center, float variance, float offset) {
    return height * std::sqrt(2 * kPi * variance) * std::cos(center * phase + offset) *
           std::exp(-variance * phase * phase);
  };
  const float x = gaussian(5.4856e-13f, 1.6810e+06f, 4.3278e+09f, shift.r) +
                  gaussian(9.7470e-14f, 2.2399e+06f, 4.5282e+09f, shift.r);
  const float y = gaussian(4.4201e-13f, 1.7953e+06f, 9.3046e+09f, shift.g);
  const float z = gaussian(5.2481e-13f, 2.2084e+06f, 6.6121e+09f, shift.b);
  return {x / kNorm, y / kNorm, z / kNorm};
}

Rgb srgb_primaries(const Xyz& c) {
  return {3.2404542f * c.x - 1.5371385f * c.y - 0.4985314f * c.z,
          -0.9692660f * c.x + 1.8760108f * c.y + 0.0415560f * c.z,
          0.0556434f * c.x - 0.2040259f * c.y + 1.0572252f * c.z};
}

template <class Function>
Rgb by_channel(const Rgb& c, const Function& f) {
  return {f(c.r), f(c.g), f(c.b)};
}

}  // namespace

Rgb thin_film_fresnel(float cos_theta, float film, float thickness_nm, const Rgb& base_f0) noexcept {
  const float cos2_inside = 1 - square(kAir / film) * (1 - cos_theta * cos_theta);
  if (cos2_inside < 0) return Rgb{1.0f};
  const float cos_inside = std::sqrt(cos2_inside);

  const float r12 = schlick(f0_of(film, kAir), cos_theta), t121 = 1 - r12;
  const float phi12 = film < kAir ? kPi : 0.0f, phi21 = kPi - phi12;
  const Rgb base_ior = by_channel(base_f0, ior_of);
  const Rgb r23 = by_channel(base_ior, [&](float ior) { return schlick(f0_of(ior, film), cos_inside); });
  const Rgb phi = by_channel(base_ior, [&](float ior) { return phi21 + (ior < film ? kPi : 0.0f); });

  const float path_difference = 2 * film * thickness_nm * 1e-9f * cos_inside;
  const Rgb r123 = by_channel(r23, [&](float r) { return std::min(std::max(r12 * r, 1e-5f), 0.9999f); });
  const auto reflected_inside = [&](float r, float rr) { return t121 * t121 * r / (1 - rr); };
  const Rgb rs{reflected_inside(r23.r, r123.r), reflected_inside(r23.g, r123.g), reflected_inside(r23.b, r123.b)};
  Rgb sum = Rgb{r12} + rs;  // without interference
  Rgb order = rs - Rgb{t121};
  for (int m = 1; m <= 2; ++m) {
    order *= by_channel(r123, [](float r) { return std::sqrt(r); });
    sum += order * (2 * srgb_primaries(sensitivity(float(m) * path_difference, phi * float(m))));
  }
  const Rgb reflected = by_channel(sum, [](float c) { return std::min(std::max(c, 0.0f), 1.0f); });
  // Where the film ends it fades, so that nothing jumps.
  return lerp(fresnel_schlick(base_f0, 1, cos_theta), reflected, smoothstep(30, thickness_nm));
}

}  // namespace alhazen
