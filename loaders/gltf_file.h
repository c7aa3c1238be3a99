// A glTF file read once, whose scene can be seen at any time of its animations.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "loaders/gltf.h"

namespace alhazen {

/// Which of a file's animations is played, and when.
struct TimeChoice {
  std::string animation{};       // a name, an index, "all", or "none": the rest pose; empty: see `time`
  std::optional<double> time{};  // seconds; none: 0, and of no animation but one that is named. Else of the first
};

class GltfFile {
 public:
  /// Reads and checks the file; of its animations, what the chosen ones hold. Throws LoadError naming file, JSON
  /// pointer, what was found and what was expected; UsageError for a choice that the file does not have.
  GltfFile(const std::filesystem::path& file, const WarningSink& warn, const SceneChoice& choice = {},
           const TimeChoice& time = {}, const std::shared_ptr<LoadBudget>& budget = std::make_shared<LoadBudget>());

  /// The same of a file's bytes, as if they were at `file`: what its URIs name is sought beside it.
  GltfFile(std::vector<uint8_t> bytes, const std::filesystem::path& file, const WarningSink& warn,
           const SceneChoice& choice, const TimeChoice& time, const std::shared_ptr<LoadBudget>& budget);
  ~GltfFile();
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  /// The scene at that time. Before the first key of an animated property it is as at that key, after the last as at
  /// the last. Throws LoadError as the constructor does.
  [[nodiscard]] LoadedScene load(double seconds);

  /// Takes a scene that load() gave, and whose meshes that do not move may have been baked, to another time. Lights,
  /// cameras, ambient light and background are the file's again; what does not move stays as it is. The shutter is
  /// shut.
  void move(Scene& scene, double seconds);

  /// Warns of what breaks the specification, though a picture can do without it: see `examine_gltf`. Of a file whose
  /// animations are not played.
  void examine();

  /// By mesh of the loaded scene, whether the animations change it or a node that shows it.
  [[nodiscard]] std::span<const char> moving_meshes() const;

  /// By mesh of the loaded scene, whether the animations change the mesh itself.
  [[nodiscard]] std::span<const char> deforming_meshes() const;

  /// By node, whether the animations change its place in the world, or whether it is shown.
  [[nodiscard]] std::span<const char> moving_nodes() const;

  /// Whether an animation is played that sets anything.
  [[nodiscard]] bool is_animated() const;

  /// Whether there are images to decode.
  [[nodiscard]] bool has_images() const;

  /// Seconds from the first key of what is animated to the last; 0 and 0 where nothing is.
  [[nodiscard]] std::pair<double, double> time_span() const;

  [[nodiscard]] std::vector<std::string> animation_names() const;
  [[nodiscard]] size_t skin_count() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen
