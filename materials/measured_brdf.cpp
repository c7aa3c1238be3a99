#include "materials/measured_brdf.h"

#include <numbers>
#include <utility>

namespace alhazen {
namespace {

constexpr float kPi = std::numbers::pi_v<float>, kInvPi = std::numbers::inv_pi_v<float>;
constexpr Vec3f kUp{0, 0, 1};

float radians(float degrees) { return degrees * kPi / 180; }

Rgb evaluate(const MeasuredTable& table, const RusinkiewiczAngles& angles) {
  const DirectionPair pair = directions(angles);
  return alhazen::evaluate(table, kUp, pair.s, pair.b);
}

float median(std::vector<float>& values) {
  const auto middle = values.begin() + ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Off the highlight, and off the horizon, where measurements end: half vectors 40 to 60 degrees from the normal, with
/// the light 3 to 25 degrees from them.
Rgb median_off_highlight(const MeasuredTable& table) {
  constexpr int kSteps = 8;
  std::vector<float> r, g, b;
  for (int h = 0; h < kSteps; ++h)
    for (int d = 0; d < kSteps; ++d)
      for (int p = 0; p < kSteps; ++p) {
        const auto step = [](int i) { return (float(i) + 0.5f) / kSteps; };
        const Rgb f = evaluate(table, {radians(40 + 20 * step(h)), radians(3 + 22 * step(d)), kPi * step(p)});
        r.push_back(f.r), g.push_back(f.g), b.push_back(f.b);
      }
  return {median(r), median(g), median(b)};
}

/// By the angle at which the highlight falls to half: there GGX's distribution, alpha² / (pi cos⁴ (alpha² + tan²)²),
/// has alpha² = tan² / (sqrt(2) - 1 + sqrt(2) tan²). Light and view stand on both sides of the half vector's meridian,
/// so that both stay above the horizon.
float highlight_roughness(const MeasuredTable& table, const Rgb& diffuse) {
  constexpr int kSteps = 512;
  constexpr float kLeast = 0.1f;  // of the diffuse light: what is weaker is no highlight
  const float base = diffuse.r + diffuse.g + diffuse.b;
  const auto above_base = [&](float theta_h) {
    const Rgb f = evaluate(table, {theta_h, radians(15), kPi / 2});
    return f.r + f.g + f.b - base;
  };
  const float peak = above_base(0);
  if (!(peak > kLeast * base)) return 1;
  for (int i = 1; i < kSteps; ++i) {
    const float root = float(i) / kSteps, theta_h = kPi / 2 * root * root;
    if (above_base(theta_h) > peak / 2) continue;
    const float tan2 = std::tan(theta_h) * std::tan(theta_h), root2 = std::numbers::sqrt2_v<float>;
    return std::sqrt(std::sqrt(tan2 / (root2 - 1 + root2 * tan2)));  // alpha = roughness²
  }
  return 1;
}

/// The integral over the lights' directions, taken over half vectors about the normal, whose spacing is the table's
/// own: ds = 4 b·h dh. The weights are scaled so that a Lambertian surface comes out exact.
Rgb directional_albedo(const MeasuredTable& table, float cos_theta) {
  constexpr int kTilts = 96, kTurns = 64;
  const Vec3f b{std::sqrt(1 - cos_theta * cos_theta), 0, cos_theta};
  Rgb sum;
  float white = 0;
  for (int i = 0; i < kTilts; ++i)
    for (int k = 0; k < kTurns; ++k) {
      const float root = (float(i) + 0.5f) / kTilts, theta = kPi / 2 * root * root;
      const float phi = 2 * kPi * (float(k) + 0.5f) / kTurns;
      const Vec3f h{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      const float bh = dot(b, h);
      const Vec3f s = 2 * bh * h - b;
      if (!(bh > 0 && s.z > 0)) continue;
      const float weight = root * std::sin(theta) * bh * s.z;
      sum += alhazen::evaluate(table, kUp, s, b) * weight, white += kInvPi * weight;
    }
  return sum * (1 / white);
}

}  // namespace

MeasuredBrdf make_measured_brdf(MeasuredTable table) {
  MeasuredBrdf brdf;
  brdf.known = float(fill_gaps(table)) / float(table.values.size());
  brdf.diffuse = median_off_highlight(table);
  brdf.roughness = highlight_roughness(table, brdf.diffuse);
  for (size_t i = 0; i < brdf.albedo.size(); ++i)
    brdf.albedo[i] = directional_albedo(table, std::max(0.02f, float(i) / float(brdf.albedo.size() - 1)));
  brdf.table = std::move(table);
  return brdf;
}

Rgb reflected_light(const MeasuredBsdf& bsdf, const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept {
  const float ns = dot(n, s);
  if (!(ns > 0)) return {};
  Rgb f = alhazen::evaluate(bsdf.brdf->table, n, s, b);
  if (bsdf.highlight_only) {
    const Rgb& base = bsdf.brdf->diffuse;
    f = {std::max(0.0f, f.r - base.r), std::max(0.0f, f.g - base.g), std::max(0.0f, f.b - base.b)};
  }
  return f * (bsdf.scale * ns);
}

MeasuredAlbedo measured_albedo(const MeasuredBsdf& bsdf, float cos_theta) noexcept {
  const auto& albedo = bsdf.brdf->albedo;
  const float position = std::min(std::max(0.0f, cos_theta), 1.0f) * float(albedo.size() - 1);
  const size_t first = std::min(size_t(position), albedo.size() - 2);
  const Rgb all = lerp(albedo[first], albedo[first + 1], position - float(first));
  const Rgb base = bsdf.brdf->diffuse * kPi;
  const Rgb diffuse{std::min(base.r, all.r), std::min(base.g, all.g), std::min(base.b, all.b)};
  return {diffuse * bsdf.scale, (all - diffuse) * bsdf.scale};
}

}  // namespace alhazen
