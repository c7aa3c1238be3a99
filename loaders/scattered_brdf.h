// From scattered measurements of a BRDF to a table.
#pragma once

#include <span>

#include "loaders/brdf_csv.h"
#include "materials/measured_table.h"

namespace alhazen {

/// A table through at least one sample, of 60 x 30 x 36 cells. The surface is taken to be isotropic and to have no
/// handedness: the table has phi_d and pi - phi_d alike, and only the angles of Rusinkiewicz count.
///
/// In each cell above the horizon a plane through the logarithms of the 12 samples that are nearest in those angles,
/// weighted by nearness (as in Renka, "Multivariate Interpolation of Large Sets of Scattered Data", 1988), kept between
/// their least and their largest. So what is the same everywhere stays so, nothing overshoots, and where nothing was
/// measured the nearest samples hold; a highlight narrower than the samples are apart is blunted. Other cells are not
/// known.
[[nodiscard]] MeasuredTable table_through(std::span<const BrdfSample> samples);

}  // namespace alhazen
