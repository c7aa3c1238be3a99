// The one form in which reflectance is looked at, measured and fitted, whatever it is made of.
#pragma once

#include <functional>

#include "core/vec.h"

namespace alhazen {

/// A BRDF at one point, in 1/sr, by linear colour: what of the irradiance from `s` leaves as radiance towards `b`.
/// s, b: unit directions away from the surface, in its own frame: x the tangent, y the bitangent, z the normal. 0 where
/// either is not above the surface. Pure, so that threads may share it.
using Brdf = std::function<Rgb(const Vec3f& s, const Vec3f& b)>;

}  // namespace alhazen
