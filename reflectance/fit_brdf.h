// The parameters with which one of the renderer's own models comes nearest to a BRDF.
#pragma once

#include <string>

#include "materials/brdf.h"
#include "materials/material.h"

namespace alhazen {

enum class FitModel : uint8_t { ggx, phong };

/// How far a model is from the data: root mean squares of log(1 + f cos) over pairs of directions and colours.
struct FitResidual {
  double rms = 0;       // of the difference
  double relative = 0;  // of the difference, over that of the data
  int pairs = 0;
};

struct BrdfFit {
  FitModel model = FitModel::ggx;
  /// What the renderer shades. ggx: glTF's dielectric with any F0 (`ior` 0, `specular_color` F0), base colour and
  /// roughness. phong: diffuse, specular and shininess as a light of unit irradiance shows them (diffuse is the albedo
  /// over pi), ambient the albedo, no mirror rays.
  Material material;
  FitResidual residual;
};

/// The best of ten fits by least squares (Levenberg and Marquardt's method) from starts that are far apart, in the
/// logarithmic metric of Löw, Kronander, Ynnerman and Unger, "BRDF Models for Accurate and Efficient Rendering of
/// Glossy Surfaces" (2012), log(1 + f cos), which keeps highlights from outweighing all else. The pairs are spread as
/// MERL's cells are, at the middles of some of them, so that highlights have many; directions beyond 80 degrees are
/// left out, where measurements are not to be trusted (Ngan, Durand and Matusik, "Experimental Analysis of BRDF
/// Models", 2005). The surface is taken to be isotropic. The same BRDF gives the same bits.
[[nodiscard]] BrdfFit fit_brdf(const Brdf& brdf, FitModel model);

/// The fitted model, in 1/sr.
[[nodiscard]] Brdf fitted_brdf(const BrdfFit& fit);

/// "GGX: base color 0.5 0.3 0.1, F0 0.04 0.04 0.04, roughness 0.3; off by 1.2 %, the root mean square of ..."
[[nodiscard]] std::string fit_summary(const BrdfFit& fit);

/// The material as an element of a glTF file's `materials`, four digits to a number.
[[nodiscard]] std::string fitted_material_json(const BrdfFit& fit, const std::string& name);

}  // namespace alhazen
