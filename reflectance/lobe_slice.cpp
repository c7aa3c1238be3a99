#include "reflectance/lobe_slice.h"

#include <algorithm>

#include "reflectance/directions.h"

namespace alhazen {
namespace {

constexpr double kHorizon = 89.99;  // just above it: on it, nothing is reflected
constexpr double kFirstStep = 0.005, kGrowth = 1.2, kLastStep = 1;

/// Ascending, each once.
std::vector<double> slice_degrees(double mirror) {
  std::vector<double> degrees{-kHorizon, mirror, kHorizon};
  for (int d = -89; d <= 89; ++d) degrees.push_back(d);
  for (double offset = kFirstStep, step = kFirstStep; step < kLastStep; offset += step *= kGrowth)
    for (const double d : {mirror - offset, mirror + offset})
      if (std::abs(d) < kHorizon) degrees.push_back(d);
  std::ranges::sort(degrees);
  degrees.erase(std::unique(degrees.begin(), degrees.end()), degrees.end());
  return degrees;
}

}  // namespace

Vec3f slice_light(double incident, double azimuth) noexcept { return direction_at(incident, azimuth); }
Vec3f slice_eye(double exitant, double azimuth) noexcept { return direction_at(-exitant, azimuth); }

LobeSlice lobe_slice(const Brdf& brdf, double incident, double azimuth) {
  LobeSlice slice{incident, slice_degrees(incident), {}};
  const Vec3f s = slice_light(incident, azimuth);
  for (const double d : slice.degrees) {
    const Rgb value = brdf(s, slice_eye(d, azimuth));
    slice.values.push_back(is_finite(value) ? value : Rgb{});
  }
  return slice;
}

float peak(const LobeSlice& slice) {
  float most = 0;
  for (const Rgb& value : slice.values) most = std::max(most, max_component(value));
  return most;
}

}  // namespace alhazen
