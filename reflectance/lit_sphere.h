// A material on a ball.
#pragma once

#include "core/image.h"
#include "reflectance/check_brdf.h"

namespace alhazen {

/// R, G, B, A, linear: a ball under a lamp at the upper left, whose irradiance of pi makes a white diffuse surface that
/// faces it 1, and a faint sky, the same all around. Its tangents run round it from the left to the right.
/// `check` holds the subject's albedo by angle.
[[nodiscard]] ColorImage lit_sphere(const Subject& subject, const BrdfCheck& check, int size);

/// The ball in a white furnace, at half exposure: what is brighter than the ground around it reflects more than it
/// receives, and a white surface that loses nothing cannot be seen.
[[nodiscard]] ColorImage furnace_sphere(const BrdfCheck& check, int size);

}  // namespace alhazen
