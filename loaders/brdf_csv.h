// Gonioreflectometer data as text: docs/reflectance.md has an example.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "loaders/load_limits.h"
#include "materials/rusinkiewicz.h"

namespace alhazen {

struct BrdfSample {
  DirectionPair directions;  // unit, the normal along z
  Rgb value;                 // 1/sr
};

/// Lines of seven numbers under the header theta_i,phi_i,theta_o,phi_o,r,g,b: degrees, of the light and of the view,
/// from the normal and about it, and the BRDF in 1/sr. Polar angles lie between -90 and 90, negative ones on the other
/// side. Empty lines, and those that start with '#', are passed over.
///
/// Throws LoadError at `place` with the line's number for whatever is otherwise, a file without a sample, and more
/// memory than the budget has.
[[nodiscard]] std::vector<BrdfSample> parse_brdf_csv(std::string_view text, const std::string& place,
                                                     LoadBudget& budget);

}  // namespace alhazen
