// Every glTF extension that is known, and what becomes of it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "loaders/gltf.h"

namespace alhazen {

struct KnownExtension {
  std::string_view name;
  Treatment treatment;
  std::string_view meaning;  // of an approximation, or of leaving it out; may be empty
};

/// In alphabetical order. docs/gltf.md has the same table.
[[nodiscard]] std::span<const KnownExtension> known_extensions();

[[nodiscard]] bool is_known(const std::string& name);

/// One that the file names; ignored if it is not known.
[[nodiscard]] Extension treat_extension(const std::string& name, bool required);

}  // namespace alhazen
