// Which of a glTF file's scenes, variants and animations are wanted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loaders/gltf_source.h"

namespace alhazen {

/// The scene of that index or name; for an empty text the file's `scene`, else its first; none where the file has none.
/// Throws UsageError where there is no such scene.
[[nodiscard]] std::optional<size_t> choose_scene(const GltfSource& source, const std::string& wanted);

/// The variant of KHR_materials_variants of that index or name; none for an empty text. Throws UsageError where there
/// is no such variant.
[[nodiscard]] std::optional<size_t> choose_variant(const GltfSource& source, const std::string& wanted);

/// The animation of that index or name; "all" of them, or "none"; for an empty text the first, if there is one. Throws
/// UsageError where there is no such animation.
[[nodiscard]] std::vector<size_t> choose_animations(const GltfSource& source, const std::string& wanted);

}  // namespace alhazen
