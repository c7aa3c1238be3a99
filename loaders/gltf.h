// glTF 2.0 and the ALHAZEN_ extensions to a Scene.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "loaders/load_limits.h"
#include "renderer/scene.h"

namespace alhazen {

/// An image still as its file has it; decoding waits until the geometry is on its way.
struct EncodedImage {
  std::string place;           // for messages: "scene.gltf: /images/3"
  std::vector<uint8_t> bytes;  // empty: not needed, or could not be read and a warning was given
  // Where it has none of its own: the roughness 1 - glossiness_factor x alpha of this image.
  uint32_t glossiness_of = kNone;
  float glossiness_factor = 1;
  bool mipmaps = false;                   // a sampler asks for them
  ColorSpace space = ColorSpace::linear;  // in which they are averaged
};

/// What of a file is wanted. Each is a name or an index; empty: the file's default.
struct SceneChoice {
  std::string scene;
  std::string variant;  // of KHR_materials_variants
};

enum class Treatment : uint8_t { supported, approximated, ignored };

/// An extension that the file names, and what became of it.
struct Extension {
  std::string name;
  bool required = false;
  Treatment treatment = Treatment::ignored;
  std::string meaning;  // of the treatment; may be empty
};

struct LoadedScene {
  Scene scene;  // images still empty (width 0), as many as `encoded`
  std::vector<EncodedImage> encoded;
  std::vector<Extension> extensions;  // of `extensionsUsed` and `extensionsRequired`
  std::shared_ptr<LoadBudget> budget;
};

using WarningSink = std::function<void(const std::string&)>;

/// Throws LoadError naming file, JSON pointer, what was found and what was expected; UsageError for a choice that the
/// file does not have. What would take more memory than the budget has is an error before it is taken.
[[nodiscard]] LoadedScene load_gltf(const std::filesystem::path& file, const WarningSink& warn,
                                    const SceneChoice& choice = {},
                                    const std::shared_ptr<LoadBudget>& budget = std::make_shared<LoadBudget>());

/// The same of a file's bytes, as if they were at `file`: what its URIs name is sought beside it.
[[nodiscard]] LoadedScene load_gltf(std::vector<uint8_t> bytes, const std::filesystem::path& file,
                                    const WarningSink& warn, const SceneChoice& choice = {},
                                    const std::shared_ptr<LoadBudget>& budget = std::make_shared<LoadBudget>());

}  // namespace alhazen
