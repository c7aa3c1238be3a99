// Cryptomatte 1.2: mattes of everything that has a name, from ids and coverages (Friedman and Jones, "Fully Automatic
// ID Mattes with Support for Motion Blur and Transparency", SIGGRAPH 2015; specification 1.2.0, Psyop).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen {

/// MurmurHash3_x86_32 with seed 0, of UTF-8.
[[nodiscard]] uint32_t name_hash(std::string_view name) noexcept;

/// A name's id as pixels hold it: the bits of its hash, exponents of zero, denormal, infinite and not-a-number avoided.
[[nodiscard]] float name_id(std::string_view name) noexcept;

/// What of a pixel shows something.
struct Coverage {
  float id = 0, coverage = 0;
};

/// Adds to the coverage of an id.
void cover(std::vector<Coverage>& pixel, float id, float coverage);

/// The largest coverages first.
void rank(std::vector<Coverage>& pixel);

/// Attributes of a file: "cryptomatte/KEY/name" and so on; names to ids as JSON in "manifest".
[[nodiscard]] std::vector<std::pair<std::string, std::string>> cryptomatte_metadata(
    const std::string& layer, const std::vector<std::string>& names);

}  // namespace alhazen
