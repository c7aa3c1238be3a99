// Procedural scenes and rays for the benches: seeded, so that every run traces the same.
#pragma once

#include "accel/geometry.h"
#include "accel/wave.h"
#include "renderer/scene.h"

namespace alhazen {

/// `count` spheres in the cube [-1, 1]³, thin enough to see deep into it, dense enough that most rays hit one; a single
/// one fills most of it.
[[nodiscard]] Geometry sphere_field(int count);

/// The same with its spheres given by ten coefficients.
[[nodiscard]] Geometry as_quadrics(Geometry spheres);

/// `count` hexagons in the cube [-1, 1]³, of any orientation: as polygons, and as a mesh of four triangles each.
struct HexagonField {
  Geometry polygons, triangles;
};
[[nodiscard]] HexagonField hexagon_field(int count);

/// A square [-1, 1]² of rolling hills about y = 0, 2 `cells`² triangles.
[[nodiscard]] TriangleMesh hills(int cells);

/// The mesh alone, in its place.
[[nodiscard]] Geometry geometry_of(TriangleMesh mesh);

/// Ten by ten spheres over hills, half of them mirrors, under a point light.
[[nodiscard]] Scene spheres_over_hills();

/// The rays through the pixel centres of a square image, neighbours side by side in blocks of 4 x 4.
[[nodiscard]] RayWave camera_wave(const Camera& camera, int size);

/// From each of the wave's hits to `p_light`; then from each in a random direction. What misses is left out.
[[nodiscard]] RayWave shadow_wave(const RayWave& wave, const HitWave& hits, const Vec3f& p_light);
[[nodiscard]] RayWave scattered_wave(const RayWave& wave, const HitWave& hits);

}  // namespace alhazen
