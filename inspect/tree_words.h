// The words that all forms of a tree share.
#pragma once

#include <string>

#include "inspect/ray_tree.h"

namespace alhazen {

/// "camera", "mirror", "refracted", "total internal reflection", "straight on".
[[nodiscard]] std::string kind_text(const TreeRay& ray);

/// "background", "environment", "emission", "ambient light".
[[nodiscard]] const char* term_text(LightTerm term);

/// Why nothing follows, or what does: "missed", "depth limit", "weight limit", "unnoticed surface", "branches",
/// "surface".
[[nodiscard]] const char* end_text(const TreeRay& ray, bool branches);

/// What the ray reaches: "lens", "background", "depth limit".
[[nodiscard]] std::string target_text(const Scene& scene, const TreeRay& ray);

/// The angle to the normal that the ray comes in at, and that of a refracted one, in degrees.
[[nodiscard]] float incident_degrees(const TreeRay& ray);
[[nodiscard]] float refracted_degrees(const TreeRay& ray);

/// "0.042", "1.45": three significant digits.
[[nodiscard]] std::string short_number(double v);

/// One number where all three are the same, else three.
[[nodiscard]] std::string short_color(const Rgb& c);

[[nodiscard]] float luminance(const Rgb& c) noexcept;

/// Encoded as sRGB, clamped: "#c08040".
[[nodiscard]] std::string hex_color(const Rgb& linear);

}  // namespace alhazen
