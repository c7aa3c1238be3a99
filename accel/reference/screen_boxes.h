// The fourth rung, for camera rays: each object's box projected to the image once, so that a ray compares its pixel
// with rectangles.
#pragma once

#include "accel/reference/object_boxes.h"

namespace alhazen {

/// How a camera maps the world to its film. Axes are orthogonal, the view runs along -z.
struct FilmProjection {
  bool perspective = true;
  Vec3d eye;        // perspective: where all its rays start
  Vec3d direction;  // orthographic: along which all its rays run
  Vec3d x, y, z;
};

/// Tries the objects in whose rectangles on the film a camera ray lies; other rays are compared with the boxes in
/// space.
class ScreenBoxes : public ObjectBoxes {
 public:
  ScreenBoxes(const Geometry& geometry, const SurfaceFilter& filter, const FilmProjection& projection);

 private:
  struct Rectangle {
    Vec2d lower, upper;
  };

  void visit_objects(const Rayf& ray, const Visit& visit, TestCounts& counts) const override;
  [[nodiscard]] bool is_camera_ray(const Rayf& ray) const;
  [[nodiscard]] Vec2d film_point(const Vec3d& p_world) const;
  [[nodiscard]] Rectangle rectangle_around(const Bounds3d& box) const;

  FilmProjection projection_;
  std::vector<Rectangle> rectangles_;  // by object
};

}  // namespace alhazen
