// What JSON has to look like, said as data: small checks that combine into the description of a file format.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "loaders/json_ref.h"

namespace alhazen {

/// Returns where the value is as it has to be, else throws LoadError with its pointer, what was found and expected.
using Check = std::function<void(const JsonRef&)>;

struct Property {
  std::string name;
  Check check;
  enum Presence : uint8_t { optional, required } presence = optional;
};
using enum Property::Presence;

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr uint64_t kMaxInt = std::numeric_limits<int32_t>::max();

[[nodiscard]] Check anything();
[[nodiscard]] Check boolean();
[[nodiscard]] Check text();
[[nodiscard]] Check one_of(std::vector<std::string> texts);
[[nodiscard]] Check one_of(std::vector<uint64_t> integers);
/// A number that is finite as a float, in [low, high].
[[nodiscard]] Check number(double low = -kUnbounded, double high = kUnbounded);
[[nodiscard]] Check number_above(double low);  // > low
[[nodiscard]] Check integer(uint64_t low = 0, uint64_t high = kMaxInt);
/// An array of exactly `count` numbers, each in [low, high].
[[nodiscard]] Check numbers(size_t count, double low = -kUnbounded, double high = kUnbounded);
[[nodiscard]] Check color();  // three numbers >= 0
/// An index into the array at `pointer` from the document's root.
[[nodiscard]] Check index_into(const std::string& pointer);
[[nodiscard]] Check list_of(Check element, size_t at_least = 0);
[[nodiscard]] Check map_of(Check value);
/// An object whose other keys are let through.
[[nodiscard]] Check object(std::vector<Property> properties);
/// An object that has no other keys than these, `extensions` and `extras`.
[[nodiscard]] Check closed_object(std::vector<Property> properties);
[[nodiscard]] Check both(Check first, Check second);

}  // namespace alhazen
