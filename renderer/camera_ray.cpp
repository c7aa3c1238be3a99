#include "renderer/camera_ray.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

Film::Film(const Camera& camera, int width, int height)
    : perspective(camera.kind == Camera::Kind::perspective), world_from_camera(camera.world_from_camera) {
  const double half = perspective ? std::tan(camera.yfov / 2) : camera.ymag;
  step = 2 * half / height, center_x = 0.5 * width, center_y = 0.5 * height;
}

Cone camera_cone(const Camera& camera, int height, int samples) {
  const double share = 2 / (height * std::sqrt(double(samples)));
  if (camera.kind == Camera::Kind::orthographic) return {float(std::abs(camera.ymag) * share), 0};
  return {0, float(std::tan(camera.yfov / 2) * share)};
}

Cone deflected(const Cone& cone, const Vec3f& d, const Vec3f& n, const Vec3f& direction, float eta, float curvature) {
  constexpr float kWidest = 2;  // as far to the sides as ahead: more says no more
  // direction = eta d + bend n. Over its width w the cone's d turns by its spread, n by curvature * w: across the plane
  // of incidence as it stands, along it over the cosines of both directions.
  const float bend = dot(direction - d * eta, n);
  const float cosines = std::max(1e-3f, std::abs(dot(d, n) * dot(direction, n)));
  const float spread = eta * cone.spread + bend * curvature * cone.width / std::sqrt(cosines);
  return {cone.width, std::isfinite(spread) ? std::clamp(spread, -kWidest, kWidest) : cone.spread};
}

FilmProjection film_projection(const Camera& camera) {
  const Affine3d& m = camera.world_from_camera;
  return {camera.kind == Camera::Kind::perspective, Vec3d(Vec3f(m.origin)), Vec3d(Vec3f(-m.z)), m.x, m.y, m.z};
}

}  // namespace alhazen
