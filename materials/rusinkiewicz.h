// The angles in which BRDFs are smooth: of the half vector, and of the light about it (Rusinkiewicz, "A New Change of
// Variables for Efficient BRDF Representation", 1998).
#pragma once

#include "core/vec.h"

namespace alhazen {

/// Radians. The fourth angle, of the half vector about the normal, does not matter to isotropic surfaces.
struct RusinkiewiczAngles {
  float theta_h = 0;  // [0, pi/2]: between the normal and the half vector
  float theta_d = 0;  // [0, pi/2]: between the half vector and either direction
  float phi_d = 0;  // [0, pi]: of the light about the half vector, from where theta_h grows; by reciprocity, modulo pi
};

/// Of a light direction s and a view direction b about the normal n; all unit, in any frame. Swapping s and b gives the
/// same bits. Small angles keep their digits: nothing is taken from a cosine.
[[nodiscard]] RusinkiewiczAngles rusinkiewicz(const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept;

struct DirectionPair {
  Vec3f s, b;
};

/// Unit directions that have these angles about the z axis, their half vector in the half plane x > 0. They may lie
/// below the horizon.
[[nodiscard]] DirectionPair directions(const RusinkiewiczAngles& angles) noexcept;

}  // namespace alhazen
