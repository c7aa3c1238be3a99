// From pixels to rays.
#pragma once

#include "accel/reference/screen_boxes.h"
#include "core/lane_vec.h"
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

/// Origins and unit directions of the rays through film points (x, y), in pixels from the top left, in world space: of
/// one point, or those of several lanes.
template <class F>
struct FilmRay {
  Vec3<F> origin, direction;
};
template <class F>
[[nodiscard, gnu::always_inline]] inline FilmRay<F> film_ray(const Film& film, const DoubleOf<F>& x,
                                                             const DoubleOf<F>& y) {
  using D = DoubleOf<F>;
  // Column by column: a whole map in lanes is more than the registers, and would be written out for each point.
  const Affine3d& m = film.world_from_camera;
  const auto all = [](const Vec3d& v) { return Vec3<D>(D(v.x), D(v.y), D(v.z)); };
  const D px = (x - D(film.center_x)) * D(film.step), py = (D(film.center_y) - y) * D(film.step);
  const Vec3<D> in_film = all(m.x) * px + all(m.y) * py;
  if (!film.perspective) return {convert<F>(in_film + all(m.origin)), broadcast<F>(Vec3f(-m.z))};
  return {broadcast<F>(Vec3f(m.origin)), convert<F>(normalize(in_film - all(m.z)))};
}

/// The ray through a film point.
[[nodiscard]] inline Rayf camera_ray(const Film& film, double x, double y) {
  const FilmRay<float> ray = film_ray<float>(film, x, y);
  return {ray.origin, ray.direction};
}

/// The same, of a single ray.
[[nodiscard]] inline Rayf camera_ray(const Camera& camera, int width, int height, double x, double y) {
  return camera_ray(Film(camera, width, height), x, y);
}

/// The cone that a ray stands for: metres across where it starts, and how much wider it gets with each (Akenine-Moller
/// et al., "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems, chapter 20).
template <class F>
struct BasicCone {
  F width = F(0), spread = F(0);  // the spread is below 0 where light converges

  /// The cone further on; beyond a focus its sides have changed places.
  [[nodiscard]] BasicCone at(const F& distance) const {
    const F w = width + spread * distance;
    const auto passed = w < F(0);
    return {select(passed, F(-w), w), select(passed, F(-spread), spread)};
  }
};
using Cone = BasicCone<float>;

/// The spread of the cone of `direction`, mirrored (`eta` 1) or refracted from `d` into where light is 1 / `eta` times
/// as slow, at a surface with unit normal n towards where d comes from, and of that mean curvature, per metre, positive
/// where it bulges that way; `width` and `spread` are those of d's cone there. Coddington's equations give a spread
/// along the plane of incidence and one across; this is between them, equal to both where d is along n (for curvature
/// in ray cones: Akenine-Moller et al., "Improved Shader and Texture Level of Detail Using Ray Cones", JCGT 10(1),
/// 2021).
template <class F>
[[nodiscard]] F deflected_spread(const F& width, const F& spread, const Vec3<F>& d, const Vec3<F>& n,
                                 const Vec3<F>& direction, const F& eta, const F& curvature) {
  constexpr float kWidest = 2;  // as far to the sides as ahead: more says no more
  // direction = eta d + bend n. Over its width w the cone's d turns by its spread, n by curvature * w: across the plane
  // of incidence as it stands, along it over the cosines of both directions.
  const F bend = dot(direction - d * eta, n);
  const F cosines = larger(F(1e-3f), absolute(F(dot(d, n) * dot(direction, n))));
  const F turned = eta * spread + bend * curvature * width / square_root(cosines);
  return select(turned - turned == F(0), clamped(turned, -kWidest, kWidest), spread);
}

/// Of one of `samples` rays through a pixel.
[[nodiscard]] Cone camera_cone(const Camera& camera, int height, int samples);

/// Where those rays meet the film, for accelerators that look there. Of the rays as they are, rounded.
[[nodiscard]] FilmProjection film_projection(const Camera& camera);

}  // namespace alhazen
