// Bodies that a ray is inside of, and which of them rules where they overlap.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "materials/material.h"

namespace alhazen {

/// The materials of the bodies around a ray, in the order of entering. More than fit are forgotten from the first on.
struct Media {
  static constexpr uint8_t kMost = 4;
  std::array<uint32_t, kMost> material{};
  uint8_t count = 0;
};

/// Whether the surfaces of a material bound a body that rays remember: a transmissive KHR_materials_volume, or a Phong
/// material with a `priority`. Other Phong bodies are surrounded by index 1 whatever they lie in.
[[nodiscard]] bool bounds_body(const Material& material) noexcept;

/// A ray's step across a boundary.
struct Boundary {
  Rgb ior_before{1.0f}, ior_after{1.0f};  // indices of refraction for red, green and blue light
  Media after;                            // of a ray that passes
  bool seen = true;  // false: another body of higher priority rules on both sides, light does not notice
};

/// The boundary of a body of `material` for a ray within `before`. Where bodies overlap, the one of the highest
/// priority rules (Phong: `priority`; volumes: 0), of equals the one entered last (after Schmidt and Budge, "Simple
/// Nested Dielectrics in Ray Traced Images", JGT 7(2), 2002). A ray that leaves what it never entered started inside.
[[nodiscard]] Boundary cross_boundary(const Media& before, uint32_t material, bool enters,
                                      const std::vector<Material>& materials) noexcept;

/// The share of light that is left after `distance` metres within `media`.
[[nodiscard]] Rgb transmittance(const Media& media, const std::vector<Material>& materials, float distance) noexcept;

}  // namespace alhazen
