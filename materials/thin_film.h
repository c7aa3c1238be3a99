// Iridescence: interference in a thin film on a surface.
#pragma once

#include "core/vec.h"

namespace alhazen {

/// Fresnel reflectance of a film of the given thickness (nanometres) and index of refraction on a base that reflects
/// `base_f0` by itself, seen from air under cos_theta; reduced to sRGB's primaries. Belcour and Barla, "A Practical
/// Extension to Microfacet Theory for the Modeling of Varying Iridescence", ACM TOG 36(4), 2017, with Schlick's
/// approximation at both faces, as KHR_materials_iridescence proposes.
[[nodiscard]] Rgb thin_film_fresnel(float cos_theta, float film_ior, float thickness_nm, const Rgb& base_f0) noexcept;

}  // namespace alhazen
