// Views of things that move: one that holds all their places.
#pragma once

#include <functional>

#include "renderer/scene.h"

namespace alhazen {

/// Shows points, in world space, to whom it is given.
using Outline = std::function<void(const std::function<void(const Vec3d& p_world)>& visit)>;

/// A three-quarter view of all the points' convex hull, as large as fits, for the aspect ratio width / height.
[[nodiscard]] Camera framing_camera(const Outline& outline, double aspect);

}  // namespace alhazen
