#include "renderer/cube_environment.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/fork_join.h"
#include "renderer/equirectangular.h"

namespace alhazen {
namespace {

/// A place in a face, from -1 to 1: s to the right, t down.
struct CubePlace {
  size_t face;
  float s, t;
};

CubePlace place_in_cube(const Vec3f& d) {
  const Vec3f a = abs(d);
  if (a.x >= a.y && a.x >= a.z) return {size_t(d.x < 0), (d.x < 0 ? d.z : -d.z) / a.x, d.y / a.x};
  if (a.y >= a.z) return {size_t(2 + (d.y < 0)), d.x / a.y, (d.y < 0 ? d.z : -d.z) / a.y};
  return {size_t(4 + (d.z < 0)), (d.z < 0 ? -d.x : d.x) / a.z, d.y / a.z};
}

Rgb bilinear(const ColorImage& face, float s, float t) {
  const float x = (s + 1) / 2 * float(face.width) - 0.5f, y = (t + 1) / 2 * float(face.height) - 0.5f;
  const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
  const auto pixel = [&](int i, int k) {
    const float* p = face.at(std::clamp(i, 0, face.width - 1), std::clamp(k, 0, face.height - 1));
    return Rgb{p[0], p[1], p[2]};
  };
  const float u = x - float(x0), v = y - float(y0);
  return lerp(lerp(pixel(x0, y0), pixel(x0 + 1, y0), u), lerp(pixel(x0, y0 + 1), pixel(x0 + 1, y0 + 1), u), v);
}

/// As many pixels along the equator as the faces have.
ColorImage equirectangular(const CubeImage& cube) {
  const int width = 4 * cube.faces[0].width, height = width / 2;
  ColorImage image{width, height, {"R", "G", "B"}, std::vector<float>(size_t(width) * size_t(height) * 3)};
  const ForkJoin order;
  tbb::parallel_for(0, height, order.task([&](int y) {
    for (int x = 0; x < width; ++x) {
      const Rgb c = cube_radiance(cube, equirectangular_direction(x, y, width, height));
      float* p = image.at(x, y);
      p[0] = c.r, p[1] = c.g, p[2] = c.b;
    }
  }));
  return image;
}

}  // namespace

Rgb cube_radiance(const CubeImage& cube, const Vec3f& direction) noexcept {
  const CubePlace place = place_in_cube(direction);
  return bilinear(cube.faces[place.face], place.s, place.t);
}

uint64_t cube_environment_bytes(uint64_t size) { return (6 + 8) * size * size * 3 * sizeof(float); }

Environment make_environment(std::span<const CubeImage> levels, const std::array<Rgb, 9>& irradiance) {
  // What a cosine lobe makes of each degree.
  constexpr double kPi = std::numbers::pi;
  constexpr std::array<double, 9> kLobe{kPi,     2 * kPi / 3, 2 * kPi / 3, 2 * kPi / 3, kPi / 4,
                                        kPi / 4, kPi / 4,     kPi / 4,     kPi / 4};
  Environment environment;
  for (size_t k = 0; k < irradiance.size(); ++k) environment.harmonics[k] = irradiance[k] * float(1 / kLobe[k]);
  for (const CubeImage& cube : levels) environment.levels.push_back(equirectangular(cube));
  return environment;
}

}  // namespace alhazen
