// Lobes cut open: the value as the distance from the point where the light meets the surface.
#pragma once

#include <span>

#include "reflectance/brdf_report.h"
#include "reflectance/drawing.h"

namespace alhazen {

/// Which distance stands for which value.
struct PolarPlot {
  Vec2d centre;              // where the light meets the surface
  double radius = 0;         // of the outermost circle
  double low = 0, high = 1;  // 1/sr, at the centre and at the radius
  bool logarithmic = false;

  [[nodiscard]] double distance(double value) const;
  /// `exitant`: degrees from the normal, positive to the right.
  [[nodiscard]] Vec2d at(double exitant, double distance) const;
};

/// Scaled so that all slices are within. By itself logarithmic where peaks are far above what is usual.
[[nodiscard]] PolarPlot polar_plot(std::span<const LobeSlice> slices, RadialScale scale, const Vec2d& centre,
                                   double radius);

/// Circles of equal value with their numbers, the surface, and angles around the rim.
[[nodiscard]] std::vector<Mark> polar_axes(const PolarPlot& plot);

/// The lobe by its luminance, from horizon to horizon.
[[nodiscard]] Outline lobe_outline(const PolarPlot& plot, const LobeSlice& slice, const Ink& ink, double width);

/// An arrow at the rim: where the light of a slice comes from.
[[nodiscard]] std::vector<Mark> light_arrow(const PolarPlot& plot, double incident, const Ink& ink);

}  // namespace alhazen
