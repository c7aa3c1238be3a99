// What is put to the test: one surface and its place. Families make them, simple ones and awkward ones.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "accel/shape.h"
#include "accel/shapes/triangle.h"
#include "crosscheck/random.h"

namespace alhazen {

// What other shapes answer, for the triangle.
[[nodiscard]] Bounds3d bounds(const Triangle& triangle) noexcept;
[[nodiscard]] Vec3d project(const Triangle& triangle, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d normal(const Triangle& triangle, const Vec3d& p_object, int face) noexcept;

}  // namespace alhazen

namespace alhazen::crosscheck {

/// Any `Shape`, or a triangle.
using Surface = std::variant<Sphere, Cylinder, Disk, Box, Polygon, Quadric, Composite, Triangle>;

struct Subject {
  Surface surface;
  Affine3d world_from_object;
  std::string origin = {};  // where it comes from, for records; empty: made up
  double lattice_step = 1;  // of the rays on the lattice: a power of two
};

[[nodiscard]] inline Bounds3d bounds_of(const Surface& surface) {
  return std::visit([](const auto& s) { return bounds(s); }, surface);
}

/// What `make_polygon` made it of; a loop that begins where the one before it repeats its own beginning is joined to
/// it.
[[nodiscard]] std::vector<std::vector<Vec3d>> loops_of(const Polygon& polygon);

/// Subjects of one kind.
struct Family {
  std::string name;
  /// The subject of one chunk of rays. `lattice`: of integer size at an integer place, so that ties are frequent and
  /// exact.
  std::function<Subject(uint64_t chunk, bool lattice, Random& random)> subject;
  uint64_t chunk_rays = 2048;  // rays for each subject
  bool robust_native = false;  // triangles: Embree's robust test in place of its default one
};

/// sphere, ellipsoid, cylinder, cone, tube (without caps), disk, ring, box, polygon (convex), star (a polygon with a
/// hole), quadric, composite, triangle and triangle-robust. Numbers are floats, so that Embree's own geometries can
/// hold the same surface.
[[nodiscard]] const std::vector<Family>& built_in_families();

}  // namespace alhazen::crosscheck
