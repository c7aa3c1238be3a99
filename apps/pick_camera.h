// --camera: which of a scene's cameras.
#pragma once

#include <string>

#include "renderer/scene.h"

namespace alhazen {

/// By its index in the file's cameras or its name; for "" the scene's first, or one that shows everything at this
/// aspect ratio. Throws UsageError that lists those there are.
[[nodiscard]] Camera pick_camera(const Scene& scene, const std::string& wanted, double aspect);

}  // namespace alhazen
