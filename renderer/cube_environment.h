// Environments that come filtered: the faces of a cube for each roughness, irradiance as spherical harmonics.
#pragma once

#include <array>
#include <span>

#include "renderer/environment.h"

namespace alhazen {

/// Square images of one size: R, G, B as linear radiance, of the faces at +x, -x, +y, -y, +z, -z. They are those of
/// OpenGL's cube maps with the rows from the bottom up, as EXT_lights_image_based has them: upside down for who looks
/// out of the middle, and not mirrored.
struct CubeImage {
  std::array<ColorImage, 6> faces;
};

/// What a cube shows along a direction of any length but 0. Bilinear within a face.
[[nodiscard]] Rgb cube_radiance(const CubeImage& cube, const Vec3f& direction) noexcept;

/// Bytes of memory that an environment of one level with faces of `size` x `size` pixels takes.
[[nodiscard]] uint64_t cube_environment_bytes(uint64_t size);

/// `levels` has one or more: level k as a lobe of roughness k / (n - 1) sees the light. `irradiance`: in the real
/// spherical harmonics of degree 0 to 2, in the order of `Environment::harmonics`.
[[nodiscard]] Environment make_environment(std::span<const CubeImage> levels, const std::array<Rgb, 9>& irradiance);

}  // namespace alhazen
