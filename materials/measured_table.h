// A BRDF as a table over Rusinkiewicz's angles, as MERL's database has them (Matusik, Pfister, Brand and McMillan, "A
// Data-Driven Reflectance Model", 2003).
#pragma once

#include <cstddef>
#include <vector>

#include "materials/rusinkiewicz.h"

namespace alhazen {

/// How many cells each angle has. Those of theta_h are equally wide in its square root, so that highlights have many;
/// those of theta_d, from 0 to pi/2, and of phi_d, from 0 to pi, are equally wide.
struct MeasuredGrid {
  int theta_h = 90, theta_d = 90, phi_d = 180;

  [[nodiscard]] size_t size() const { return size_t(theta_h) * size_t(theta_d) * size_t(phi_d); }
};

struct MeasuredTable {
  MeasuredGrid grid;
  std::vector<Rgb> values;  // 1/sr at the middle of each cell; phi_d runs fastest, theta_h slowest. Below 0: not known
};

/// The angles in the middle of a cell; the middle is that of the square root for theta_h.
[[nodiscard]] RusinkiewiczAngles cell_middle(const MeasuredGrid& grid, int theta_h, int theta_d, int phi_d) noexcept;

/// Gives each entry that is not known the mean of its neighbours that are, or were given one before it: the nearest
/// known values spread. Returns how many were known; where none was, nothing changes.
size_t fill_gaps(MeasuredTable& table);

/// The BRDF, in 1/sr, between what the eight entries around the angles say: trilinear in the cells' own spacing,
/// continuous everywhere, where phi_d wraps and at the poles too. 0 where s or b is not above the surface. The table
/// has no gaps; n, s, b are unit, in any frame. Takes the same time everywhere; threads may share the table.
[[nodiscard]] Rgb evaluate(const MeasuredTable& table, const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept;

}  // namespace alhazen
