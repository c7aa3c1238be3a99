// Measured BRDFs from files, whichever of the formats they have.
#pragma once

#include <filesystem>
#include <span>

#include "loaders/load_limits.h"
#include "materials/measured_brdf.h"

namespace alhazen {

/// MERL's format or comma-separated text, told apart by the first bytes: counts have zeros among theirs, text has none.
/// Throws LoadError at `place`, see `parse_merl` and `parse_brdf_csv`.
[[nodiscard]] MeasuredBrdf parse_measured_brdf(std::span<const uint8_t> file, const std::string& place,
                                               LoadBudget& budget);

/// The same of a regular file. Throws LoadError where it cannot be read, too.
[[nodiscard]] MeasuredBrdf load_measured_brdf(const std::filesystem::path& file, LoadBudget& budget);

}  // namespace alhazen
