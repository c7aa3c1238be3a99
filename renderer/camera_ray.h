// From pixels to rays.
#pragma once

#include "accel/reference/screen_boxes.h"
#include "core/ray.h"
#include "renderer/scene.h"

namespace alhazen {

/// The ray through a film point (x, y), in pixels from the top left of a picture of width x height, in world space. Its
/// direction has unit length.
[[nodiscard]] Rayf camera_ray(const Camera& camera, int width, int height, double x, double y);

/// Where those rays meet the film, for accelerators that look there. Of the rays as they are, rounded.
[[nodiscard]] FilmProjection film_projection(const Camera& camera);

}  // namespace alhazen
