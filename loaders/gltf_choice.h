// Which of a glTF file's scenes and variants is wanted.
#pragma once

#include <optional>
#include <string>

#include "loaders/gltf_source.h"

namespace alhazen {

/// The scene of that index or name; for an empty text the file's `scene`, else its first; none where the file has none.
/// Throws UsageError where there is no such scene.
[[nodiscard]] std::optional<size_t> choose_scene(const GltfSource& source, const std::string& wanted);

/// The variant of KHR_materials_variants of that index or name; none for an empty text. Throws UsageError where there
/// is no such variant.
[[nodiscard]] std::optional<size_t> choose_variant(const GltfSource& source, const std::string& wanted);

}  // namespace alhazen
