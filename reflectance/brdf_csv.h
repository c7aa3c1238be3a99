// A BRDF as a table, the form in which measured reflectance comes as text.
#pragma once

#include <functional>
#include <string_view>

#include "materials/brdf.h"

namespace alhazen {

/// The columns: angles of light and eye in degrees, theta from the normal, phi from the tangent towards the bitangent;
/// the value in 1/sr, linear.
inline constexpr std::string_view kBrdfCsvHeader = "theta_i,phi_i,theta_o,phi_o,r,g,b";

/// How many rows there are for a step in degrees: theta below 90, phi below 360; where it is isotropic, phi_i is 0.
[[nodiscard]] double brdf_csv_rows(double step, bool isotropic) noexcept;

/// Calls write(text) with the header and with the rows for one theta_i and phi_i after another, numbers as the shortest
/// that read back the same.
void write_brdf_csv(const Brdf& brdf, double step, bool isotropic, const std::function<void(std::string_view)>& write);

}  // namespace alhazen
