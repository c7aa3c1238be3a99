#include "renderer/camera_ray.h"

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

FilmProjection film_projection(const Camera& camera) {
  const Affine3d& m = camera.world_from_camera;
  return {camera.kind == Camera::Kind::perspective, Vec3d(Vec3f(m.origin)), Vec3d(Vec3f(-m.z)), m.x, m.y, m.z};
}

}  // namespace alhazen
