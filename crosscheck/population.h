// Kinds of rays: everyday ones, and those that intersectors get wrong.
#pragma once

#include <string>
#include <vector>

#include "crosscheck/judge.h"

namespace alhazen::crosscheck {

enum class Population : uint8_t {
  uniform,     // from around the subject, through its box
  aimed,       // at an edge, vertex, rim, apex or seam, the direction off by 0, ±1 ... ±64 floats
  silhouette,  // past the surface at 2^-k of its size, k = 0 ... 30, on either side
  lattice,     // integers everywhere: ties are frequent and exact
  axis,        // directions with one or two components 0 or -0
  length,      // directions of length 2^-60 ... 2^60
  range,       // t_min or t_max within four floats of the hit
  spawned,     // from the surface, off by up to four floats
  inside,      // from within the subject's box
  special,     // from the centre, or a point on an edge, rim or apex itself
  camera,      // the primary rays of a scene's picture, see scene_check.h
};

inline constexpr int kPopulations = 11;
[[nodiscard]] const char* name_of(Population population);

/// Rays of one subject: every population but `camera`.
class RayMaker {
 public:
  RayMaker(const Subject& subject, const Judge& judge)
      : subject_(&subject), judge_(&judge), box_(bounds_of(subject.surface)) {}

  [[nodiscard]] Rayf ray(Population population, Random& random) const;

 private:
  [[nodiscard]] Vec3d center() const { return (box_.lower + box_.upper) * 0.5; }
  [[nodiscard]] Vec3d in_box(double scale, Random& random) const;
  [[nodiscard]] Vec3d near_box(double scale, Random& random) const;
  [[nodiscard]] Vec3d on_surface(Random& random) const;  // nearly
  [[nodiscard]] Vec3d outer_origin(Random& random) const;
  [[nodiscard]] Rayf through(const Vec3d& origin_object, const Vec3d& target_object, Random& random) const;
  [[nodiscard]] Rayf uniform_ray(Random& random) const;
  [[nodiscard]] Rayf silhouette_ray(Random& random) const;
  [[nodiscard]] Rayf lattice_ray(Random& random) const;
  [[nodiscard]] Rayf axis_ray(Random& random) const;
  [[nodiscard]] Rayf clipped_ray(Random& random) const;

  const Subject* subject_;
  const Judge* judge_;
  Bounds3d box_;
};

}  // namespace alhazen::crosscheck
