// Light from all around, from infinitely far: an image of the whole sphere of directions.
#pragma once

#include <array>
#include <vector>

#include "core/image.h"
#include "core/transform.h"
#include "core/vec.h"

namespace alhazen {

/// Equirectangular images in the environment's own axes, y up: the middle of a row looks along -z, its left end along
/// +z, with +x in the right half. Colours are linear radiance.
struct Environment {
  std::vector<ColorImage> levels;   // R, G, B; level k as a GGX lobe of roughness k / (n - 1) about a direction sees it
  std::array<Rgb, 9> harmonics;     // of the radiance, in the real spherical harmonics of degree 0 to 2
  Affine3f environment_from_world;  // a rotation
  float strength = 1;               // multiplies the radiance
  bool seen = true;                 // by rays that come straight from the camera, and refracted ones
};

/// Prefilters an image of at least 1 x 1 pixels, finite and not negative.
[[nodiscard]] Environment make_environment(ColorImage image);

/// What a lobe of that roughness in [0, 1] about a unit direction sees; a mirror at 0. Interpolates linearly.
[[nodiscard]] Rgb environment_radiance(const Environment& environment, const Vec3f& direction_world,
                                       float roughness) noexcept;

/// What a white Lambertian surface with unit normal n reflects: irradiance over pi, to 1 % of what is physical for
/// smooth light (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001).
[[nodiscard]] Rgb environment_diffuse(const Environment& environment, const Vec3f& n_world) noexcept;

/// A photographer's studio in grey: a large soft light above on the left, a lower one on the right, a strip behind, a
/// bright floor that fades to darker walls. `environment_from_world` turns it so that it stands around a camera that
/// looks along `forward_world`.
[[nodiscard]] Environment studio_environment(const Vec3d& forward_world);

}  // namespace alhazen
