// Light from all around, from infinitely far: an image of the whole sphere of directions.
#pragma once

#include <array>
#include <vector>

#include "core/image.h"
#include "core/lane_vec.h"
#include "core/transform.h"

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

/// The real spherical harmonics of degree 0 to 2 in a unit direction.
template <class F>
[[nodiscard]] std::array<F, 9> harmonics_at(const Vec3<F>& d) {
  const F x = d.x, y = d.y, z = d.z;
  return {F(0.282095f),
          F(0.488603f) * y,
          F(0.488603f) * z,
          F(0.488603f) * x,
          F(1.092548f) * x * y,
          F(1.092548f) * y * z,
          F(0.315392f) * (F(3) * z * z - F(1)),
          F(1.092548f) * x * z,
          F(0.546274f) * (x * x - y * y)};
}

template <class F>
[[nodiscard]] Vec3<F> rotated(const Affine3f& m, const Vec3<F>& v) {
  return broadcast<F>(m.x) * v.x + broadcast<F>(m.y) * v.y + broadcast<F>(m.z) * v.z;
}

/// Prefilters an image of at least 1 x 1 pixels, finite and not negative.
[[nodiscard]] Environment make_environment(ColorImage image);

/// What a lobe of that roughness in [0, 1] about a unit direction sees; a mirror at 0. Interpolates linearly.
template <class F>
[[nodiscard]] BasicRgb<F> environment_radiance(const Environment& environment, const Vec3<F>& direction_world,
                                               std::type_identity_t<F> roughness) noexcept;
[[nodiscard]] inline Rgb environment_radiance(const Environment& environment, const Vec3f& direction_world,
                                              float roughness) noexcept {
  return environment_radiance<float>(environment, direction_world, roughness);
}

/// What a white Lambertian surface with unit normal n reflects: irradiance over pi, to 1 % of what is physical for
/// smooth light (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001).
template <class F>
[[nodiscard]] BasicRgb<F> environment_diffuse(const Environment& environment, const Vec3<F>& n_world) noexcept {
  // The cosine lobe's factors by degree, over pi.
  constexpr std::array<float, 9> kLobe{1, 2 / 3.0f, 2 / 3.0f, 2 / 3.0f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f};
  const std::array<F, 9> basis = harmonics_at(rotated(environment.environment_from_world, n_world));
  BasicRgb<F> sum{F(0)};
  for (size_t k = 0; k < 9; ++k) sum += BasicRgb<F>(environment.harmonics[k]) * F(basis[k] * F(kLobe[k]));
  const auto positive = [&](const F& c) { return larger(F(0), F(c * F(environment.strength))); };
  return {positive(sum.r), positive(sum.g), positive(sum.b)};
}
[[nodiscard]] inline Rgb environment_diffuse(const Environment& environment, const Vec3f& n_world) noexcept {
  return environment_diffuse<float>(environment, n_world);
}

/// A photographer's studio in grey: a large soft light above on the left, a lower one on the right, a strip behind, a
/// bright floor that fades to darker walls. `environment_from_world` turns it so that it stands around a camera that
/// looks along `forward_world`.
[[nodiscard]] Environment studio_environment(const Vec3d& forward_world);

}  // namespace alhazen
