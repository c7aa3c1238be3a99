// The properties of a glTF file that an animation may set, by their JSON pointers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loaders/json_check.h"

namespace alhazen {

struct AnimatedProperty {
  enum class Kind : uint8_t { numbers, rotation, truth, weights };
  Kind kind = Kind::numbers;
  size_t width = 1;                             // numbers of a value; 0 for weights: as many as the mesh has targets
  double low = -kUnbounded, high = kUnbounded;  // values beyond are brought back, as splines may overshoot
};

using PointerTokens = std::vector<std::string>;

/// The parts of a JSON pointer (RFC 6901), unescaped; none where it does not begin with "/".
[[nodiscard]] std::optional<PointerTokens> pointer_tokens(const std::string& pointer);

/// The property that the pointer names, if that is one of those known here.
[[nodiscard]] std::optional<AnimatedProperty> animated_property(const PointerTokens& tokens);

/// Whether what holds the property is in the file. Objects of defaults that may be left out there are created:
/// `pbrMetallicRoughness`, `spot`, extensions.
[[nodiscard]] bool make_place(nlohmann::json& root, const PointerTokens& tokens);

}  // namespace alhazen
