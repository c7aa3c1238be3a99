// What both ways of shading share, hit by hit and in lanes: each is written once for a float and for lanes of floats.
#pragma once

#include "materials/base_layer.h"
#include "materials/material.h"
#include "renderer/surface.h"

namespace alhazen {

/// A direction in tangent space brought to the world.
template <class F>
[[nodiscard]] Vec3<F> world_from_tangent(const BasicSurfacePoint<F>& surface, const Vec3<F>& m) {
  const Vec3<F> t = surface.tangent_world, bitangent = cross(surface.ns_world, t) * surface.bitangent_sign;
  return normalize(t * m.x + bitangent * m.y + surface.ns_world * m.z);
}

/// The interpolated normal, as a texture turns it where the surface has a tangent.
template <class F>
[[nodiscard]] Vec3<F> shading_normal(const BasicSurfacePoint<F>& s, const TextureUse& texture, float scale,
                                     const TextureTable& table) {
  if (!texture) return s.ns_world;
  const MaskOf<F> has_tangent = dot(s.tangent_world, s.tangent_world) > F(0);
  if (!any_of(has_tangent)) return s.ns_world;
  const Vec3<F> n = world_from_tangent(s, tangent_space_normal(texture, scale, table, s.inputs()));
  const F squared = dot(n, n);
  return select(MaskOf<F>(has_tangent && squared > F(0) && squared - squared == F(0)), n, s.ns_world);
}

/// Metres of the surface that a cone as wide as that stands for. A slanted surface shows more of itself along one axis:
/// the mean of both, for mip levels have no direction.
template <class F>
[[nodiscard]] F footprint(const F& cone_width, const Vec3<F>& ng_world, const Vec3<F>& direction) {
  return cone_width / square_root(larger(F(1e-3f), absolute(dot(ng_world, direction))));
}

/// A bumped normal may send the mirror ray below the surface: turned back to the side that is seen from `b`.
template <class F>
[[nodiscard]] Vec3<F> above_surface(const Vec3<F>& ng_world, const Vec3<F>& b, const Vec3<F>& mirrored) {
  const Vec3<F> ng = select(dot(ng_world, b) < F(0), -ng_world, ng_world);
  const F below = dot(mirrored, ng);
  return select(below < F(0), normalize(mirrored - (F(2) * below) * ng), mirrored);
}

/// The roughness of two surfaces one after the other.
template <class F>
[[nodiscard]] F blurred_by(const F& before, const F& then) {
  return smaller(F(square_root(F(before * before + then * then))), F(1));
}

/// What a white Lambertian surface reflects of the light without a place.
template <class F>
[[nodiscard]] BasicRgb<F> ambient_light(const Scene& scene, const Vec3<F>& n) {
  const BasicRgb<F> ambient(scene.ambient);
  return scene.environment ? ambient + environment_diffuse(*scene.environment, n) : ambient;
}

/// The environment as a lobe about a direction sees it.
template <class F>
[[nodiscard]] BasicRgb<F> blurred(const Scene& scene, const Vec3<F>& direction, std::type_identity_t<F> roughness) {
  return scene.environment ? environment_radiance(*scene.environment, direction, roughness)
                           : BasicRgb<F>(scene.ambient);
}

}  // namespace alhazen
