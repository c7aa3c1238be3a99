// What lobes of rough surfaces share: distributions of facets and how these hide each other. All angles are given by
// cosines or components of unit vectors in a frame of tangent, bitangent and normal.
#pragma once

#include <numbers>

#include "core/lane_memory.h"

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

/// 1 / (4 n·s n·b) x G for height-correlated Smith, from |(alpha_t t·w, alpha_b b·w, n·w)|.
template <class F>
[[nodiscard]] F smith_visibility(F ns, F stretched_s, F nb, F stretched_b) {
  return F(0.5f) / (ns * stretched_b + nb * stretched_s);
}

/// `ggx` below where the roughness is the same in all directions, from the cosines n·s > 0 and n·b.
template <class F>
[[nodiscard]] F isotropic_ggx(F alpha, F ns, F nb, const Vec3<F>& n, const Vec3<F>& h) {
  const F a2 = alpha * alpha, nh = dot(n, h);
  // 1 - (n·h)² as |n x h|²: no cancellation where a sharp highlight needs the digits.
  const Vec3<F> nxh = cross(n, h);
  const F q = dot(nxh, nxh) + a2 * nh * nh;
  const auto stretched = [&](F nw) { return square_root(nw * nw * (F(1) - a2) + a2); };
  return a2 * F(std::numbers::inv_pi_v<float>) / (q * q) * smith_visibility(ns, stretched(ns), nb, stretched(nb));
}

/// GGX: distribution x height-correlated Smith visibility, D G / (4 n·s n·b). s, b, h: unit directions to the light, to
/// the eye and halfway between. 0 where a direction is below the surface.
[[nodiscard]] float ggx(const Alpha& alpha, const ShadingFrame& frame, const Vec3f& s, const Vec3f& b,
                        const Vec3f& h) noexcept;

/// Sheen: the "Charlie" distribution x its visibility (Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF",
/// 2017), for sheen roughness in [0, 1], of which alpha is the square.
[[nodiscard]] float charlie(float roughness, float n_dot_s, float n_dot_b, float n_dot_h) noexcept;

/// The share of uniform light that `charlie` reflects towards a direction, from a table of integrals; error below 0.01.
[[nodiscard]] float charlie_albedo(float roughness, float cos_theta) noexcept;

/// Tables of lobes have this many entries each way: by roughness, then by cosine.
inline constexpr int kLobeTableSize = 32;

/// Calls `visit(entry, weight)` for the four entries around (roughness, cosine), with their bilinear weights.
template <class F, class Visit>
void visit_lobe_table(F roughness, F cos_theta, const Visit& visit) {
  using I = IntOf<F>;
  const F x = clamped(roughness, 0, 1) * F(kLobeTableSize - 1), y = clamped(cos_theta, 0, 1) * F(kLobeTableSize - 1);
  const I i = smaller(convert<I>(x), I(kLobeTableSize - 2)), k = smaller(convert<I>(y), I(kLobeTableSize - 2));
  const F u = x - convert<F>(i), v = y - convert<F>(k);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      visit(I((i + I(a)) * I(kLobeTableSize) + k + I(b)), F((a ? u : F(1) - u) * (b ? v : F(1) - v)));
}

/// The share of uniform light that GGX with Schlick's Fresnel (f0, f90) reflects: f0 x scale + f90 x bias (Karis, "Real
/// Shading in Unreal Engine 4", 2013), from a table of integrals; error below 0.012 up to 75 degrees from the normal,
/// 0.042 at 88.
template <class F>
struct BasicSplitSum {
  F scale = 1, bias = 0;
};
using SplitSum = BasicSplitSum<float>;

/// Pairs of scale and bias.
[[nodiscard]] const float* ggx_albedo_table() noexcept;

template <class F = float>
[[nodiscard]] BasicSplitSum<F> ggx_albedo(std::type_identity_t<F> roughness,
                                          std::type_identity_t<F> cos_theta) noexcept {
  const float* table = ggx_albedo_table();
  BasicSplitSum<F> sum{F(0), F(0)};
  visit_lobe_table<F>(roughness, cos_theta, [&](const IntOf<F>& entry, const F& weight) {
    sum.scale += gather<F>(table, entry + entry) * weight, sum.bias += gather<F>(table + 1, entry + entry) * weight;
  });
  return sum;
}

}  // namespace alhazen
