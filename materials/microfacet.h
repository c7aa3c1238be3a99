// What lobes of rough surfaces share: distributions of facets and how these hide each other. All angles are given by
// cosines or components of unit vectors in a frame of tangent, bitangent and normal.
#pragma once

#include "core/vec.h"

namespace alhazen {

/// Axes in which a lobe is evaluated: n the normal, t and b across it; unit, perpendicular.
struct ShadingFrame {
  Vec3f t, b, n;
};

/// Some frame about a unit normal (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017).
[[nodiscard]] ShadingFrame frame_about(const Vec3f& n) noexcept;

/// The roughness alpha along t and b. Where both are one, the lobe is isotropic and never looks at t and b.
struct Alpha {
  float t = 1, b = 1;
};

/// alpha = roughness², at least 1e-3 so that highlights of punctual lights stay finite; drawn out along t by a strength
/// in [0, 1] as KHR_materials_anisotropy says.
[[nodiscard]] Alpha alpha_of(float roughness, float anisotropy = 0) noexcept;

/// GGX: distribution x height-correlated Smith visibility, D G / (4 n·s n·b). s, b, h: unit directions to the light, to
/// the eye and halfway between. 0 where a direction is below the surface.
[[nodiscard]] float ggx(const Alpha& alpha, const ShadingFrame& frame, const Vec3f& s, const Vec3f& b,
                        const Vec3f& h) noexcept;

/// Sheen: the "Charlie" distribution x its visibility (Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF",
/// 2017), for sheen roughness in [0, 1], of which alpha is the square.
[[nodiscard]] float charlie(float roughness, float n_dot_s, float n_dot_b, float n_dot_h) noexcept;

/// The share of uniform light that `charlie` reflects towards a direction, from a table of integrals; error below 0.01.
[[nodiscard]] float charlie_albedo(float roughness, float cos_theta) noexcept;

/// The share of uniform light that GGX with Schlick's Fresnel (f0, f90) reflects: f0 x scale + f90 x bias (Karis, "Real
/// Shading in Unreal Engine 4", 2013), from a table of integrals; error below 0.012 up to 75 degrees from the normal, 0.042 at 88.
struct SplitSum {
  float scale = 1, bias = 0;
};
[[nodiscard]] SplitSum ggx_albedo(float roughness, float cos_theta) noexcept;

}  // namespace alhazen
