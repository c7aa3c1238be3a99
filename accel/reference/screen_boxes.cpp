#include "accel/reference/screen_boxes.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

ScreenBoxes::ScreenBoxes(const Geometry& geometry, const SurfaceFilter& filter, const FilmProjection& projection)
    : ObjectBoxes(geometry, filter), projection_(projection) {
  for (const Bounds3d& box : boxes_) rectangles_.push_back(rectangle_around(box));
}

/// The point's image; not finite, or behind, where the caller has not looked after that.
Vec2d ScreenBoxes::film_point(const Vec3d& p_world) const {
  const FilmProjection& f = projection_;
  if (f.perspective) {
    const Vec3d v = p_world - f.eye;
    return {dot(v, f.x) / -dot(v, f.z), dot(v, f.y) / -dot(v, f.z)};
  }
  const Vec3d p = p_world - f.direction * (dot(p_world, f.z) / dot(f.direction, f.z));
  return {dot(p, f.x), dot(p, f.y)};
}

ScreenBoxes::Rectangle ScreenBoxes::rectangle_around(const Bounds3d& box) const {
  Rectangle around{{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
  if (is_empty(box)) return around;
  for (int k = 0; k < 8; ++k) {
    const Vec3d p{(k & 1 ? box.upper : box.lower).x, (k & 2 ? box.upper : box.lower).y,
                  (k & 4 ? box.upper : box.lower).z};
    // A box that reaches behind the eye, or nearly, may show anywhere.
    const Vec3d from_eye = p - projection_.eye;
    const bool in_front = -dot(from_eye, projection_.z) > 1e-6 * length(from_eye);
    if (projection_.perspective && !in_front) return {{-HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL}};
    const Vec2d at = film_point(p);
    const double margin = 1e-6 * (std::abs(at.x) + std::abs(at.y)) + 1e-9 * length(p);
    around.lower = {std::min(around.lower.x, at.x - margin), std::min(around.lower.y, at.y - margin)};
    around.upper = {std::max(around.upper.x, at.x + margin), std::max(around.upper.y, at.y + margin)};
  }
  return around;
}

bool ScreenBoxes::is_camera_ray(const Rayf& ray) const {
  if (!projection_.perspective) return Vec3d(ray.direction) == projection_.direction && ray.t_min >= 0;
  return Vec3d(ray.origin) == projection_.eye && ray.t_min >= 0 && dot(Vec3d(ray.direction), projection_.z) < 0;
}

void ScreenBoxes::visit_objects(const Rayf& ray, const Visit& visit, TestCounts& counts) const {
  if (!is_camera_ray(ray)) return ObjectBoxes::visit_objects(ray, visit, counts);
  const Vec2d at = film_point(Vec3d(ray.origin) + (projection_.perspective ? Vec3d(ray.direction) : Vec3d{}));
  counts.boxes += rectangles_.size();
  for (uint32_t object = 0; object < rectangles_.size(); ++object) {
    const auto& [lower, upper] = rectangles_[object];
    if (at.x >= lower.x && at.x <= upper.x && at.y >= lower.y && at.y <= upper.y) visit(object);
  }
}

}  // namespace alhazen
