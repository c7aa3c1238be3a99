// A lobe as heat over all exitant directions.
#pragma once

#include "core/image.h"
#include "materials/brdf.h"

namespace alhazen {

/// Luminances of a BRDF for light from one direction: the hemisphere as a disk of equal areas, its centre the normal,
/// the tangent to the left, the bitangent down, so that light from the left is mirrored to the right. NaN outside.
struct HemisphereMap {
  double incident = 0, azimuth = 0;  // of the light, degrees
  int size = 0;                      // pixels across
  std::vector<float> values;         // rows from the top, 1/sr
};

/// Each pixel the mean of four directions; the one that holds the mirror direction shows that, if it is more.
[[nodiscard]] HemisphereMap hemisphere_map(const Brdf& brdf, double incident, double azimuth, int size);

/// Powers of ten between which colours run.
struct HeatScale {
  int lowest = -3, highest = 0;
  [[nodiscard]] float share(double value) const;  // 0 to 1
};

/// Around what the maps hold, at most six powers of ten.
[[nodiscard]] HeatScale heat_scale(const std::vector<HemisphereMap>& maps);

/// R, G, B, A, linear; transparent outside.
[[nodiscard]] ColorImage heat_picture(const HemisphereMap& map, const HeatScale& scale);

}  // namespace alhazen
