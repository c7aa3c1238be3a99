#include "apps/pick_camera.h"

#include "apps/suggestion.h"
#include "core/error.h"
#include "renderer/render.h"

namespace alhazen {

Camera pick_camera(const Scene& scene, const std::string& wanted, double aspect) {
  if (wanted.empty()) return scene.cameras.empty() ? framing_camera(scene.geometry, aspect) : scene.cameras[0];
  for (size_t i = 0; i < scene.cameras.size(); ++i)
    if (std::to_string(scene.camera_index[i]) == wanted) return scene.cameras[i];
  std::vector<std::string> names, descriptions;
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const std::string& name = scene.cameras[i].name;
    if (name == wanted) return scene.cameras[i];
    if (!name.empty()) names.push_back(name);
    descriptions.push_back(std::to_string(scene.camera_index[i]) + (name.empty() ? "" : " '" + name + "'"));
  }
  throw UsageError("--camera: there is no camera '" + wanted + "'; the scene has " +
                   (descriptions.empty() ? "none" : joined(descriptions)) + did_you_mean(wanted, names));
}

}  // namespace alhazen
