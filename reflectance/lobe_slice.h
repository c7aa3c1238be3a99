// What a lobe looks like, cut open.
#pragma once

#include <vector>

#include "materials/brdf.h"

namespace alhazen {

/// Values of a BRDF in the plane of incidence.
struct LobeSlice {
  double incident = 0;          // degrees from the normal
  std::vector<double> degrees;  // of the exitant direction, ascending: from -90, the light's side, to 90
  std::vector<Rgb> values;      // 1/sr
};

/// Where the light comes from `incident` degrees, the plane turned by `azimuth` degrees from the tangent. Steps of a
/// degree, far smaller ones about the mirror direction.
[[nodiscard]] LobeSlice lobe_slice(const Brdf& brdf, double incident, double azimuth);

/// The direction of the light, and that of the eye `exitant` degrees from the normal on the other side of it.
[[nodiscard]] Vec3f slice_light(double incident, double azimuth) noexcept;
[[nodiscard]] Vec3f slice_eye(double exitant, double azimuth) noexcept;

/// The largest component in the slice.
[[nodiscard]] float peak(const LobeSlice& slice);

}  // namespace alhazen
