// What of a scene moves while the shutter is open, at one time of it.
#pragma once

#include "renderer/scene.h"

namespace alhazen {

/// Kinds and names are those of the first, or left out.
[[nodiscard]] Light mix(const Light& a, const Light& b, float f);
[[nodiscard]] Camera mix(const Camera& a, const Camera& b, float f);

/// Whether a picture from this camera depends on the time at which its rays are traced.
[[nodiscard]] bool is_moving(const Scene& scene, const Camera& camera);

}  // namespace alhazen
