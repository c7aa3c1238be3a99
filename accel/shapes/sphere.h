// The sphere x² + y² + z² = radius² about the origin of its own space.
#pragma once

#include "core/ray.h"
#include "core/vec.h"

namespace alhazen {

struct Sphere {
  float radius = 1;
};

/// The parameters at which a line crosses a closed surface, in ascending order: none or a pair (enter, leave).
struct Crossings {
  double t[2];
  int count = 0;
};

/// Where a ray crosses the sphere: none or two crossings, nearer first.
///
/// space     the sphere's own. The direction need not be unit length: t is in units of its length.
/// range     all t, negative too; the caller clips to [ray.t_min, ray.t_max].
/// none      a miss, a tangent graze, a zero direction, or NaN in any input.
/// accuracy  double on the given input; rounded once to float by the caller.
/// source    roots: Press et al., Numerical Recipes §5.6; discriminant from the point of closest approach: Haines,
/// Günther
///           and Akenine-Möller, Ray Tracing Gems (2019), ch. 7.
[[nodiscard]] Crossings crossings(const Sphere& sphere, const Rayd& ray_object) noexcept;

[[nodiscard]] Bounds3d bounds(const Sphere& sphere) noexcept;

/// The point of the surface nearest to `p_object`, a point within rounding of it.
[[nodiscard]] Vec3d project(const Sphere& sphere, const Vec3d& p_object) noexcept;

/// The outward unit normal at a point of the surface.
[[nodiscard]] Vec3d normal(const Sphere& sphere, const Vec3d& p_object) noexcept;

/// u = 0.5 + atan2(x, z) / 2π, v = acos(y / r) / π.
[[nodiscard]] Vec2f texture_coordinates(const Sphere& sphere, const Vec3d& p_object) noexcept;

/// ∂p/∂u at a point of the surface, not normalised: the direction in which the texture's u grows. Zero at the poles.
[[nodiscard]] Vec3d u_tangent(const Sphere& sphere, const Vec3d& p_object) noexcept;

}  // namespace alhazen
