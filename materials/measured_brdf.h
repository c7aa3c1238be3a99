// A measured surface (ALHAZEN_materials_measured; docs/scene-format.md): its table, and what light from all around
// needs to know of it.
#pragma once

#include <array>
#include <string>

#include "materials/measured_table.h"

namespace alhazen {

struct MeasuredBrdf {
  std::string name;  // of its file
  MeasuredTable table;
  float known = 1;  // share of the table's entries that the file has

  // Parted into what is the same in all directions and the highlight, for light that has no place.
  Rgb diffuse;                 // 1/sr: the median off the highlight
  float roughness = 1;         // of the GGX lobe whose highlight is as wide at half its height; 1 where there is none
  std::array<Rgb, 32> albedo;  // directional, by the cosine of the view from 0 to 1
};

/// Fills the table's gaps and works out the rest. At least one entry is known, every one finite.
[[nodiscard]] MeasuredBrdf make_measured_brdf(MeasuredTable table);

/// The measured surface at one point.
struct MeasuredBsdf {
  const MeasuredBrdf* brdf;
  float scale = 1;
  bool highlight_only = false;  // what exceeds `diffuse`
};

/// BRDF x cosine for one light direction, as glTF's: what a light of unit irradiance on a surface facing it sends
/// towards b. n: unit normal turned towards b; s: unit, to the light; b: unit, back along the ray.
[[nodiscard]] Rgb reflected_light(const MeasuredBsdf& bsdf, const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept;

/// The shares of uniform light that go towards a direction; together the directional albedo.
struct MeasuredAlbedo {
  Rgb diffuse, highlight;

  [[nodiscard]] Rgb total() const { return diffuse + highlight; }
};
[[nodiscard]] MeasuredAlbedo measured_albedo(const MeasuredBsdf& bsdf, float cos_theta) noexcept;

}  // namespace alhazen
