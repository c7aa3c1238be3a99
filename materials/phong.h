// The course's Phong model at one point (ALHAZEN_materials_phong; docs/scene-format.md section 2).
#pragma once

#include "materials/material.h"

namespace alhazen {

/// Phong's parameters with textures and vertex colour applied.
struct PhongBsdf {
  Rgb ambient, diffuse, specular;
  float shininess;
  Rgb reflection, transmission;
  float ior;
  bool fresnel;
};

[[nodiscard]] PhongBsdf phong_bsdf(const Material& material, const TextureTable& table,
                                   const SurfaceInputs& inputs) noexcept;

/// What a light of unit I adds: r_d max(0, n·s) + r_s max(0, r·b)^alpha, the second term only where n·s > 0.
/// n: unit normal turned towards b; s: unit, to the light; b: unit, back along the ray.
[[nodiscard]] Rgb reflected_light(const PhongBsdf& bsdf, const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept;

}  // namespace alhazen
