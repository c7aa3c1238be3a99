// From pixels to rays.
#pragma once

#include "accel/reference/screen_boxes.h"
#include "core/ray.h"
#include "renderer/scene.h"

namespace alhazen {

/// A camera before a picture of width x height pixels.
struct Film {
  Film(const Camera& camera, int width, int height);

  bool perspective;
  Affine3d world_from_camera;
  double step, center_x, center_y;  // a pixel's side at distance 1 (orthographic: in metres); the middle, in pixels
};

/// The ray through a film point (x, y), in pixels from the top left, in world space. Its direction has unit length.
[[nodiscard]] inline Rayf camera_ray(const Film& film, double x, double y) {
  const Affine3d& m = film.world_from_camera;
  const Vec3d p{(x - film.center_x) * film.step, (film.center_y - y) * film.step, 0};
  if (film.perspective) return {Vec3f(m.origin), Vec3f(normalize(transform_vector(m, p - Vec3d{0, 0, 1})))};
  return {Vec3f(transform_point(m, p)), Vec3f(-m.z)};
}

/// The same, of a single ray.
[[nodiscard]] inline Rayf camera_ray(const Camera& camera, int width, int height, double x, double y) {
  return camera_ray(Film(camera, width, height), x, y);
}

/// The cone that a ray stands for: metres across where it starts, and how much wider it gets with each (Akenine-Moller
/// et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, chapter 20).
struct Cone {
  float width = 0, spread = 0;  // the spread is below 0 where light converges

  /// The cone further on; beyond a focus its sides have changed places.
  [[nodiscard]] Cone at(float distance) const {
    const float w = width + spread * distance;
    return w < 0 ? Cone{-w, -spread} : Cone{w, spread};
  }
};

/// The cone of `direction`, mirrored (`eta` 1) or refracted from `d` into where light is 1 / `eta` times as slow, at a
/// surface with unit normal n towards where d comes from, and of that mean curvature, per metre, positive where it
/// bulges that way. Coddington's equations give a spread along the plane of incidence and one across; this is between
/// them, equal to both where d is along n (for curvature in ray cones: Akenine-Moller et al., "Improved Shader and
/// Texture Level of Detail Using Ray Cones", JCGT 10(1), 2021).
[[nodiscard]] Cone deflected(const Cone& cone, const Vec3f& d, const Vec3f& n, const Vec3f& direction, float eta,
                             float curvature);

/// Of one of `samples` rays through a pixel.
[[nodiscard]] Cone camera_cone(const Camera& camera, int height, int samples);

/// Where those rays meet the film, for accelerators that look there. Of the rays as they are, rounded.
[[nodiscard]] FilmProjection film_projection(const Camera& camera);

}  // namespace alhazen
