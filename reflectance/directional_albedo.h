// How much a surface reflects, all directions taken together.
#pragma once

#include "materials/brdf.h"

namespace alhazen {

struct Albedo {
  Rgb value;
  double error = 0;  // estimated, of any component
};

/// The share of a thin beam from `s` that is reflected: the integral of f(s, b) n·b over all b. More than 1 is more
/// than comes in. Deterministic: adaptive cubature in polar coordinates about the mirror direction, finer towards it,
/// so that lobes of a thousandth of a radian are seen. Error below 1e-3 of the value, or of 1 if that is more, where
/// `error` says so (tests: DirectionalAlbedo.*); what is no number counts as 0.
[[nodiscard]] Albedo beam_albedo(const Brdf& brdf, const Vec3f& s);

/// How bright the surface is, seen from `b` in surroundings of 1 all around (the white furnace): the integral of
/// f(s, b) n·s over all s. The same as `beam_albedo` where light and eye may change places.
[[nodiscard]] Albedo furnace_albedo(const Brdf& brdf, const Vec3f& b);

}  // namespace alhazen
