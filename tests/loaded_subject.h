// Scenes from files for tests of whole pictures.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "loaders/gltf.h"
#include "loaders/image_decode.h"
#include "renderer/render.h"

namespace alhazen {

/// A scene from a file, ready to be traced.
struct Subject {
  Scene scene;
  Camera camera;
  std::vector<Opacity> opacity;
  std::unique_ptr<AcceleratedScene> accelerated;

  Subject(const std::filesystem::path& file, double aspect) {
    LoadedScene loaded = load_gltf(file, [](const std::string&) {});
    decode_textures(loaded, [](const std::string&) {});
    scene = std::move(loaded.scene);
    bake_single_instances(scene.geometry);
    camera = scene.cameras.empty() ? framing_camera(scene.geometry, aspect) : scene.cameras[0];
    if (scene.lights.empty() && !scene.has_ambient) add_studio_lights(scene, camera);
    accelerated = std::make_unique<AcceleratedScene>(scene.geometry, surface_filter(scene, opacity));
  }
  Subject(const Subject&) = delete;

  [[nodiscard]] RenderResult result(const RenderOptions& options) const {
    RenderControl control;
    return render(scene, *accelerated, camera, options, control);
  }
  [[nodiscard]] ColorImage picture(const RenderOptions& options) const { return result(options).color; }
};

/// The showcase, and those that pictures are tested with.
inline std::vector<std::filesystem::path> small_scenes() {
  std::vector<std::filesystem::path> files{ALHAZEN_SHOWCASE};
  for (const auto& entry : std::filesystem::directory_iterator(ALHAZEN_TEST_IMAGES))
    if (entry.path().extension() == ".gltf") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

}  // namespace alhazen
