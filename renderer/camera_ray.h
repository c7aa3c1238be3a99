// From pixels to rays.
#pragma once

#include "accel/reference/screen_boxes.h"
#include "core/ray.h"
#include "renderer/scene.h"

namespace alhazen {

/// The ray through a film point (x, y), in pixels from the top left of a picture of width x height, in world space. Its
/// direction has unit length.
[[nodiscard]] Rayf camera_ray(const Camera& camera, int width, int height, double x, double y);

/// The cone that a ray stands for: metres across where it starts, and how much wider it gets with each (Akenine-Moller
/// et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, chapter 20).
struct Cone {
  float width = 0, spread = 0;

  [[nodiscard]] float width_at(float distance) const { return width + spread * distance; }
};

/// Of one of `samples` rays through a pixel.
[[nodiscard]] Cone camera_cone(const Camera& camera, int height, int samples);

/// Where those rays meet the film, for accelerators that look there. Of the rays as they are, rounded.
[[nodiscard]] FilmProjection film_projection(const Camera& camera);

}  // namespace alhazen
