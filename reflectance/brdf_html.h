// The sheet as a page whose light can be moved.
#pragma once

#include "reflectance/brdf_report.h"

namespace alhazen {

/// Self-contained; without scripts it shows one angle of incidence.
[[nodiscard]] std::string brdf_html(const BrdfReport& report);

}  // namespace alhazen
