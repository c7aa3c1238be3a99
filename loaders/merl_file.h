// MERL's .binary files of measured BRDFs.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "loaders/load_limits.h"
#include "materials/measured_table.h"

namespace alhazen {

/// Three 32-bit integers, the counts of theta_h, theta_d and phi_d (90, 90 and 180 in MERL's database; here from 1 to
/// 1024 each), then as many 64-bit floats for red, for green and for blue, all little-endian; 1500, 1500 / 1.15 and
/// 1500 / 1.66 of them stand for 1 / sr. Negative entries are not known.
///
/// Throws LoadError at `place` for a file of another length, counts out of range, entries that are not finite or above
/// `kLargestBrdf`, none that is known, and more memory than the budget has.
[[nodiscard]] MeasuredTable parse_merl(std::span<const uint8_t> file, const std::string& place, LoadBudget& budget);

/// 1/sr: beyond what lobes of any width reach, at grazing angles too.
inline constexpr double kLargestBrdf = 1e9;

}  // namespace alhazen
