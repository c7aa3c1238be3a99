// Views and light for scenes that bring none of their own.
#include <cmath>
#include <numbers>

#include "renderer/render.h"

namespace alhazen {
namespace {

/// At `eye`, looking along `forward`, +y up.
Affine3d look_along(const Vec3d& eye, const Vec3d& forward) {
  const Vec3d z = -normalize(forward), x = normalize(cross(Vec3d{0, 1, 0}, z));
  return {x, cross(z, x), z, eye};
}

}  // namespace

Camera framing_camera(const Bounds3d& bounds, double aspect) {
  Camera camera;
  camera.name = "framing";
  camera.yfov = 35 * std::numbers::pi / 180;
  const bool empty = is_empty(bounds);
  const Vec3d center = empty ? Vec3d{} : (bounds.lower + bounds.upper) * 0.5;
  const Vec3d half = empty ? Vec3d{1, 1, 1} : bounds.upper - center;
  camera.world_from_camera = look_along(center, Vec3d{-0.55, -0.38, -0.8});
  // Step back until every corner of the box is inside the view.
  const Affine3d& m = camera.world_from_camera;
  const double tan_y = std::tan(camera.yfov / 2) * 0.94, tan_x = tan_y * aspect;
  double distance = 0;
  for (int k = 0; k < 8; ++k) {
    const Vec3d corner{k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z};
    const double needed = std::max(std::abs(dot(corner, m.x)) / tan_x, std::abs(dot(corner, m.y)) / tan_y);
    distance = std::max(distance, needed + dot(corner, m.z));
  }
  if (!(distance > 0)) distance = 1;
  camera.world_from_camera.origin = center + m.z * distance;
  return camera;
}

void add_studio_lights(Scene& scene, const Camera& camera) {
  const Affine3d& m = camera.world_from_camera;
  const auto directional = [&](const char* name, const Vec3d& from_camera, const Rgb& lux) {
    Light light;
    light.name = name, light.kind = Light::Kind::directional, light.intensity = lux;
    light.direction_world = -normalize(transform_vector(m, from_camera));
    scene.lights.push_back(light);
  };
  directional("studio key", {-0.6, 0.8, 0.7}, Rgb(2.4f, 2.35f, 2.25f));
  directional("studio fill", {0.9, 0.2, 0.6}, Rgb(0.65f, 0.7f, 0.8f));
  directional("studio rim", {0.4, 0.7, -0.8}, Rgb(1.3f));
  if (!scene.has_ambient) scene.ambient = Rgb(0.28f, 0.29f, 0.31f);
  if (!scene.has_background) scene.background = Rgb(0.32f, 0.33f, 0.35f);
}

}  // namespace alhazen
