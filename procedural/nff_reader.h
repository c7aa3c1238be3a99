// Scenes from .nff files.
#pragma once

#include <istream>
#include <string>

#include "procedural/nff.h"

namespace alhazen {

/// Reads all of the format but for animations. `name` stands in errors, which give the line.
/// @throw LoadError  for unknown entities, missing, surplus or non-finite numbers, degenerate sizes
[[nodiscard]] NffScene read_nff(std::istream& in, const std::string& name);

}  // namespace alhazen
