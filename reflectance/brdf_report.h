// All that there is to show of a subject, worked out once for every form.
#pragma once

#include <optional>

#include "reflectance/check_brdf.h"
#include "reflectance/fit_brdf.h"
#include "reflectance/lobe_slice.h"

namespace alhazen {

enum class RadialScale : uint8_t { automatic, linear, logarithmic };

struct BrdfOptions {
  std::vector<double> incident{0, 30, 60, 80};  // degrees from the normal, below 90
  double azimuth = 0;                           // of the plane of incidence, degrees from the tangent
  RadialScale scale = RadialScale::automatic;   // of the polar slices
  std::optional<FitModel> fit = {};             // what to bring near the subject
};

struct BrdfReport {
  Subject subject;
  BrdfOptions options;
  std::vector<LobeSlice> slices;  // by options.incident
  BrdfCheck check;
  std::optional<BrdfFit> fit;
  std::vector<LobeSlice> fitted;  // the fit's slices; none without one
};

[[nodiscard]] BrdfReport brdf_report(const Subject& subject, const BrdfOptions& options);

/// "roughness 0.22, metallic 1"
[[nodiscard]] std::string settings_text(const Subject& subject);

/// What was fitted, how far it is off, and as which glTF material it can be used.
[[nodiscard]] std::string fit_text(const BrdfReport& report);

/// A table for a terminal: albedo and peak by angle, then what the laws say.
[[nodiscard]] std::string brdf_text(const BrdfReport& report);

}  // namespace alhazen
