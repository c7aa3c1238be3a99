#include "reflectance/check_brdf.h"

#include <cmath>
#include <numbers>

#include "core/sampling.h"
#include "loaders/in_parallel.h"
#include "reflectance/directions.h"

namespace alhazen {
namespace {

constexpr double kEnergyTolerance = 2e-3, kReciprocityTolerance = 1e-3;
constexpr float kFaint = 1e-3f * std::numbers::inv_pi_v<float>;  // 1/sr
constexpr uint32_t kPairs = 16384, kTurns = 512;
constexpr float kTurned = 0.02f;   // relative: turning rounds, which narrow lobes feel
constexpr double kNearest = 1e-4;  // radians from the mirror direction, of the pairs near it

double least_component(const Rgb& c) { return double(std::min(c.r, std::min(c.g, c.b))); }

std::vector<double> angles() {
  std::vector<double> degrees;
  for (int i = 0; i <= 34; ++i) degrees.push_back(2.5 * i);
  degrees.insert(degrees.end(), {86, 87, 88, 89, 89.5, 89.9, 89.99});
  return degrees;
}

/// Uniform over the hemisphere.
Vec3f hemisphere_direction(const Vec2f& u) {
  const double z = 1 - double(u.x), across = std::sqrt(1 - z * z), phi = 2 * std::numbers::pi * double(u.y);
  return Vec3f(Vec3d(across * std::cos(phi), across * std::sin(phi), z));
}

/// The mirror direction of `s`, moved by an angle whose logarithm is uniform: so that lobes of any width are met.
Vec3f near_mirror(const Vec3f& s, const Vec2f& u) {
  const double delta = kNearest * std::pow(1 / kNearest, double(u.x)), psi = 2 * std::numbers::pi * double(u.y);
  const Vec3d m = normalize(Vec3d(mirrored(s)));
  const Vec3d x = normalize(cross(std::abs(m.x) < 0.7 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), m)), y = cross(m, x);
  const Vec3d d = m * std::cos(delta) + (x * std::cos(psi) + y * std::sin(psi)) * std::sin(delta);
  return Vec3f(Vec3d(d.x, d.y, std::abs(d.z)));
}

struct Pair {
  Vec3f s, b;
};
Pair pair_of(uint32_t i) {
  const Vec3f s = hemisphere_direction(sobol_owen(i, 1));
  const Vec2f u = sobol_owen(i, 2);
  return {s, i % 2 ? near_mirror(s, u) : hemisphere_direction(u)};
}

float difference(const Rgb& a, const Rgb& b) {
  const auto of = [](float x, float y) { return std::abs(x - y) / std::max({std::abs(x), std::abs(y), kFaint}); };
  return std::max(of(a.r, b.r), std::max(of(a.g, b.g), of(a.b, b.b)));
}

Vec3f turned(const Vec3f& d, float c, float s) { return {c * d.x - s * d.y, s * d.x + c * d.y, d.z}; }

bool is_isotropic(const Brdf& brdf) {
  for (uint32_t i = 0; i < kTurns; ++i) {
    const auto [s, b] = pair_of(i);
    const float angle = 2 * std::numbers::pi_v<float> * sobol_owen(i, 3).x, x = std::cos(angle), y = std::sin(angle);
    const Rgb here = brdf(s, b), there = brdf(turned(s, x, y), turned(b, x, y));
    if (is_finite(here) != is_finite(there) || difference(here, there) > kTurned) return false;
  }
  return true;
}

void check_pairs(const Brdf& brdf, BrdfCheck& check) {
  check.pairs = kPairs;
  check.least_value.value = INFINITY;
  for (uint32_t i = 0; i < kPairs; ++i) {
    const auto [s, b] = pair_of(i);
    const Rgb there = brdf(s, b), back = brdf(b, s);
    if (!is_finite(there) || !is_finite(back)) {
      ++check.not_finite;
      continue;
    }
    if (const double least = least_component(there); least < check.least_value.value)
      check.least_value = {least, theta_of(s), theta_of(b)};
    if (const double unequal = double(difference(there, back)); unequal > check.most_unequal.value)
      check.most_unequal = {unequal, theta_of(s), theta_of(b)};
  }
}

AlbedoAtAngle albedo_at(const Subject& subject, double degrees, double azimuth) {
  const Vec3f d = direction_at(degrees, azimuth);
  return {degrees, beam_albedo(subject.brdf, d), furnace_albedo(subject.brdf, d),
          subject.smooth ? subject.smooth(d.z) : RayShares{}};
}

std::vector<AlbedoAtAngle> albedos(const Subject& subject, double azimuth) {
  const std::vector<double> degrees = angles();
  std::vector<AlbedoAtAngle> at(degrees.size());
  for_each_in_parallel(degrees.size(), [&](size_t i) { at[i] = albedo_at(subject, degrees[i], azimuth); });
  return at;
}

void widen(Finding& most, Finding& least, const Rgb& value, double error, double degrees) {
  const double v = double(max_component(value));
  if (v - error > most.value) most = {v - error, degrees, degrees};
  if (v < least.value) least = {v, degrees, degrees};
}

void account(const AlbedoAtAngle& at, BrdfCheck& check) {
  widen(check.most_beam, check.least_beam, at.beam.value + at.rays.transmitted, at.beam.error, at.degrees);
  widen(check.most_furnace, check.least_furnace, at.furnace.value, at.furnace.error, at.degrees);
  if (check.most_beam.light == at.degrees && check.most_beam.value > 1 + kEnergyTolerance)
    check.gains_from = std::min(check.gains_from, at.degrees);
  const double rays = double(max_component(at.rays.mirrored + at.rays.transmitted));
  if (rays > check.most_rays.value) check.most_rays = {rays, at.degrees, at.degrees};
}

}  // namespace

bool BrdfCheck::keeps_energy() const {
  return std::max({most_beam.value, most_furnace.value, most_rays.value}) <= 1 + kEnergyTolerance;
}
bool BrdfCheck::keeps_reciprocity() const { return most_unequal.value <= kReciprocityTolerance; }
bool BrdfCheck::keeps_positivity() const { return least_value.value >= 0 && not_finite == 0; }

BrdfCheck check_brdf(const Subject& subject, double azimuth) {
  BrdfCheck check;
  check.isotropic = is_isotropic(subject.brdf);
  check.least_beam.value = check.least_furnace.value = INFINITY;
  check.albedo = albedos(subject, azimuth);
  for (const AlbedoAtAngle& at : check.albedo) account(at, check);
  if (!check.isotropic)
    for (const double turn : {45.0, 90.0})
      for (const AlbedoAtAngle& at : albedos(subject, azimuth + turn)) account(at, check);
  check_pairs(subject.brdf, check);
  return check;
}

}  // namespace alhazen
