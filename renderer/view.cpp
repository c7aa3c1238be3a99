// Views and light for scenes that bring none of their own.
#include <cmath>
#include <limits>
#include <numbers>

#include "renderer/framing.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

constexpr double kFilled = 0.94;  // of the picture's width or height, by what is framed

/// At `eye`, looking along `forward`, +y up.
Affine3d look_along(const Vec3d& eye, const Vec3d& forward) {
  const Vec3d z = -normalize(forward), x = normalize(cross(Vec3d{0, 1, 0}, z));
  return {x, cross(z, x), z, eye};
}

}  // namespace

Camera framing_camera(const Outline& outline, double aspect) {
  Camera camera;
  camera.name = "framing";
  camera.yfov = 35 * std::numbers::pi / 180;
  camera.world_from_camera = look_along({}, Vec3d{-0.55, -0.38, -0.8});
  const Affine3d& m = camera.world_from_camera;
  const double tan_y = std::tan(camera.yfov / 2) * kFilled, tan_x = tan_y * aspect;
  // A point p is between two opposite sides of the view from c where |p.x - c.x| <= (c.z - p.z) tan_x, in the camera's
  // axes: right of one where p.x + p.z tan_x <= c.x + c.z tan_x, and so on. The sides rest on the points.
  constexpr double kNowhere = -std::numeric_limits<double>::infinity();
  double right = kNowhere, left = kNowhere, top = kNowhere, bottom = kNowhere, front = kNowhere;
  outline([&](const Vec3d& p_world) {
    const Vec3d p{dot(p_world, m.x), dot(p_world, m.y), dot(p_world, m.z)};
    right = std::max(right, p.z * tan_x + p.x), left = std::max(left, p.z * tan_x - p.x);
    top = std::max(top, p.z * tan_y + p.y), bottom = std::max(bottom, p.z * tan_y - p.y);
    front = std::max(front, p.z);
  });
  if (front == kNowhere) right = left = top = bottom = front = 0;  // nothing to see
  double z = std::max((right + left) / (2 * tan_x), (top + bottom) / (2 * tan_y));
  const double x = (right - left) / 2, y = (top - bottom) / 2;
  if (!(z > front)) z = front + 1;  // a point, or a line along the view: any distance does
  camera.world_from_camera.origin = m.x * x + m.y * y + m.z * z;
  return camera;
}

Camera framing_camera(const Geometry& geometry, double aspect) {
  return framing_camera([&](const auto& visit) { visit_outline(geometry, visit); }, aspect);
}

void add_studio_lights(Scene& scene, const Camera& camera) {
  const Affine3d& m = camera.world_from_camera;
  const auto directional = [&](const char* name, const Vec3d& from_camera, const Rgb& lux) {
    Light light;
    light.name = name, light.kind = Light::Kind::directional, light.intensity = lux;
    light.direction_world = -normalize(transform_vector(m, from_camera));
    scene.lights.push_back(light);
  };
  directional("studio key", {-0.6, 0.8, 0.7}, Rgb(2.0f, 1.96f, 1.88f));
  directional("studio fill", {0.9, 0.2, 0.6}, Rgb(0.5f, 0.54f, 0.62f));
  directional("studio rim", {0.4, 0.7, -0.8}, Rgb(1.1f));
  if (!scene.has_ambient && !scene.environment) scene.environment = studio_environment(-m.z);
  if (!scene.has_background) scene.background = Rgb(0.32f, 0.33f, 0.35f);
}

}  // namespace alhazen
