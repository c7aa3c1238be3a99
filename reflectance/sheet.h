// One page about a subject: lobes, albedo, heat, balls and what the laws say.
#pragma once

#include <string>
#include <vector>

#include "reflectance/brdf_report.h"
#include "reflectance/drawing.h"

namespace alhazen {

/// The page, whose heat is that of the slice in the middle of the list.
[[nodiscard]] Drawing brdf_sheet(const BrdfReport& report);

/// The page without heat, and what is laid over it for each angle of incidence: its heat and its lobe.
struct LiveSheet {
  Drawing fixed;
  std::vector<std::vector<Mark>> by_angle;
};
[[nodiscard]] LiveSheet live_sheet(const BrdfReport& report, const std::vector<double>& angles);

}  // namespace alhazen
