// Whether a BRDF keeps the laws that a real surface keeps: energy, reciprocity, positivity.
#pragma once

#include <vector>

#include "reflectance/directional_albedo.h"
#include "reflectance/subject.h"

namespace alhazen {

/// A value and the directions, in degrees from the normal, where it was found.
struct Finding {
  double value = 0;
  double light = 0, eye = 0;
};

/// Under one angle to the normal.
struct AlbedoAtAngle {
  double degrees = 0;
  Albedo beam, furnace;  // light from there, and an eye there
  RayShares rays;        // 0 where nothing is smooth
};

struct BrdfCheck {
  bool isotropic = true;              // turning light and eye together about the normal changes nothing
  std::vector<AlbedoAtAngle> albedo;  // ascending angles, in the plane of the tangent turned by the azimuth asked for
  Finding most_beam, least_beam;      // shares of a beam that are reflected or transmitted, the largest component
  Finding most_furnace, least_furnace;
  double gains_from = 90;  // degrees: the least angle whose beam leaves as more than came in
  Finding most_rays;       // mirrored and transmitted together; 0 where nothing is smooth
  Finding least_value;     // in 1/sr, any component
  Finding most_unequal;    // |f(s, b) - f(b, s)| over the larger of them
  size_t pairs = 0;        // of directions that were tried
  size_t not_finite = 0;   // of these, where a value is no number

  [[nodiscard]] bool keeps_energy() const;
  [[nodiscard]] bool keeps_reciprocity() const;
  [[nodiscard]] bool keeps_positivity() const;
  [[nodiscard]] bool keeps_all() const { return keeps_energy() && keeps_reciprocity() && keeps_positivity(); }
};

/// Albedos from the normal to 89.99 degrees, and where it is not isotropic in two more planes; pairs of directions from
/// a fixed low-discrepancy sequence, half of them near mirror directions of each other. Differences below a thousandth,
/// and of values below a thousandth of a white diffuse surface's, are rounding.
[[nodiscard]] BrdfCheck check_brdf(const Subject& subject, double azimuth);

}  // namespace alhazen
