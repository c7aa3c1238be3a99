#include "renderer/camera_ray.h"

#include <cmath>

namespace alhazen {

Rayf camera_ray(const Camera& camera, int width, int height, double x, double y) {
  const double half = camera.kind == Camera::Kind::perspective ? std::tan(camera.yfov / 2) : camera.ymag;
  const double step = 2 * half / height;
  const Vec3d film{(x - 0.5 * width) * step, (0.5 * height - y) * step, 0};
  const Affine3d& m = camera.world_from_camera;
  if (camera.kind == Camera::Kind::perspective)
    return {Vec3f(m.origin), Vec3f(normalize(transform_vector(m, film - Vec3d{0, 0, 1})))};
  return {Vec3f(transform_point(m, film)), Vec3f(-m.z)};
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
