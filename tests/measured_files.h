// Measured BRDFs for tests: files written from BRDFs that are known.
#pragma once

#include <cstring>
#include <numbers>
#include <random>
#include <string>

#include "materials/brdf.h"
#include "materials/measured_table.h"
#include "materials/metallic_roughness.h"

namespace alhazen {

inline Brdf lambert_brdf(const Rgb& albedo) {
  return [=](const Vec3f& s, const Vec3f& b) {
    return s.z > 0 && b.z > 0 ? albedo * std::numbers::inv_pi_v<float> : Rgb{};
  };
}

/// glTF's dielectric of diffuse colour and F0.
inline MetallicRoughnessBsdf ggx_bsdf(const Rgb& diffuse, const Rgb& f0, float roughness) {
  MetallicRoughnessBsdf bsdf{diffuse, 0, roughness, f0, 1, 0, 1};
  return bsdf;
}

inline Brdf ggx_brdf(const Rgb& diffuse, const Rgb& f0, float roughness) {
  return [bsdf = ggx_bsdf(diffuse, f0, roughness)](const Vec3f& s, const Vec3f& b) {
    if (!(s.z > 0 && b.z > 0)) return Rgb{};
    return reflected_light(bsdf, LayerFrames(Vec3f{0, 0, 1}), s, b) * (1 / s.z);
  };
}

/// Ward's isotropic model ("Measuring and Modeling Anisotropic Reflection", 1992) as Walter's "Notes on the Ward BRDF"
/// (2005) write it.
inline Brdf ward_brdf(const Rgb& diffuse, const Rgb& specular, float alpha) {
  return [=](const Vec3f& s, const Vec3f& b) {
    if (!(s.z > 0 && b.z > 0)) return Rgb{};
    const Vec3f h = normalize(s + b);
    const float tan2 = (1 - h.z * h.z) / (h.z * h.z), pi = std::numbers::pi_v<float>;
    const float lobe = std::exp(-tan2 / (alpha * alpha)) / (4 * pi * alpha * alpha * std::sqrt(s.z * b.z));
    return diffuse * (1 / pi) + specular * lobe;
  };
}

inline MeasuredTable table_of(const Brdf& brdf, const MeasuredGrid& grid = {}) {
  MeasuredTable table{grid, {}};
  for (int h = 0; h < grid.theta_h; ++h)
    for (int d = 0; d < grid.theta_d; ++d)
      for (int p = 0; p < grid.phi_d; ++p) {
        const DirectionPair pair = directions(cell_middle(grid, h, d, p));
        table.values.push_back(pair.s.z > 0 && pair.b.z > 0 ? brdf(pair.s, pair.b) : Rgb{-1});
      }
  return table;
}

/// A MERL file's bytes. `noise`: relative, a standard deviation.
inline std::string merl_bytes(const MeasuredTable& table, float noise = 0) {
  const int32_t counts[] = {table.grid.theta_h, table.grid.theta_d, table.grid.phi_d};
  std::string bytes(reinterpret_cast<const char*>(counts), sizeof counts);
  std::mt19937 random(1);
  std::normal_distribution<float> error(1, noise);
  const auto put = [&](double value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const auto& [channel, scale] :
       {std::pair(&Rgb::r, 1500 / 1.0), std::pair(&Rgb::g, 1500 / 1.15), std::pair(&Rgb::b, 1500 / 1.66)})
    for (const Rgb& value : table.values)
      put(value.*channel < 0 ? -1 : double(std::max(0.0f, value.*channel * (noise > 0 ? error(random) : 1))) * scale);
  return bytes;
}

/// Comma-separated text: every pair of directions `step` degrees apart in both polar angles, twice that in azimuth.
inline std::string csv_of(const Brdf& brdf, int step) {
  std::string text = "# written by a test\ntheta_i,phi_i,theta_o,phi_o,r,g,b\n";
  const auto direction = [](int theta, int phi) {
    const float t = float(theta) * std::numbers::pi_v<float> / 180, p = float(phi) * std::numbers::pi_v<float> / 180;
    return Vec3f{std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
  };
  for (int i = 0; i < 90; i += step)
    for (int o = 0; o < 90; o += step)
      for (int phi = 0; phi <= 180; phi += 2 * step) {
        const Rgb f = brdf(direction(i, 0), direction(o, phi));
        char line[160];
        std::snprintf(line, sizeof line, "%d,0,%d,%d,%.9g,%.9g,%.9g\n", i, o, phi, double(f.r), double(f.g),
                      double(f.b));
        text += line;
      }
  return text;
}

}  // namespace alhazen
