#include "inspect/tree_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "inspect/labels.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

float degrees(float radians) { return radians * 180 / std::numbers::pi_v<float>; }

}  // namespace

std::string kind_text(const TreeRay& ray) {
  constexpr std::array kKinds{"camera", "mirror", "refracted", "straight on"};
  return ray.total ? "total internal reflection" : kKinds[size_t(ray.kind)];
}

const char* term_text(LightTerm term) {
  constexpr std::array kTerms{"background", "environment", "emission", "ambient light"};
  return kTerms[size_t(term)];
}

const char* end_text(const TreeRay& ray, bool branches) {
  constexpr std::array kEnds{"surface", "unnoticed surface", "missed", "depth limit", "weight limit"};
  return ray.end == RayEnd::shaded && branches ? "branches" : kEnds[size_t(ray.end)];
}

std::string target_text(const Scene& scene, const TreeRay& ray) {
  if (ray.hit) return node_label(scene, ray.hit->ids.node);
  if (ray.end != RayEnd::missed) return end_text(ray, false);
  return ray.terms.empty() || ray.terms[0].term == LightTerm::background ? "background" : "environment";
}

float incident_degrees(const TreeRay& ray) {
  return degrees(std::acos(std::clamp(-dot(ray.hit->ns_world, ray.ray.direction), 0.0f, 1.0f)));
}

float refracted_degrees(const TreeRay& ray) {
  const float c = -dot(ray.hit->ns_world, ray.ray.direction);
  const float eta = ray.interface->ior_before.g / ray.interface->ior_after.g;
  return degrees(std::asin(std::min(1.0f, eta * std::sqrt(std::max(0.0f, 1 - c * c)))));
}

std::string short_number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", v);
  return text;
}

std::string short_color(const Rgb& c) {
  if (c.r == c.g && c.g == c.b) return short_number(double(c.r));
  return short_number(double(c.r)) + " " + short_number(double(c.g)) + " " + short_number(double(c.b));
}

float luminance(const Rgb& c) noexcept { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

std::string hex_color(const Rgb& linear) {
  const auto byte = [](float v) { return int(std::lround(255 * srgb_from_linear(std::clamp(v, 0.0f, 1.0f)))); };
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(linear.r), byte(linear.g), byte(linear.b));
  return text;
}

}  // namespace alhazen
