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

/// What the mirror and the refracted ray weigh: reflection and transmission, times the exact F and 1 - F where the
/// material asks for them. `fresnel`: F, 1 past the critical angle; `passes`: whether there is a refracted ray, else
/// its share is mirrored, too.
struct PhongRays {
  Rgb mirrored, refracted;
};
[[nodiscard]] PhongRays ray_weights(const PhongBsdf& bsdf, float fresnel, bool passes) noexcept;

}  // namespace alhazen
