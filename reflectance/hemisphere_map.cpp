#include "reflectance/hemisphere_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "inspect/layer_picture.h"
#include "inspect/tree_words.h"
#include "reflectance/directions.h"
#include "reflectance/lobe_slice.h"

namespace alhazen {
namespace {

constexpr int kMostDecades = 6;

float finite_luminance(const Rgb& value) { return is_finite(value) ? luminance(value) : 0; }

/// A point of the picture, in the unit disk.
Vec2d disk_point(double x, double y, int size) { return {1 - 2 * x / size, 2 * y / size - 1}; }

constexpr double kHalves[] = {0.25, 0.75};  // middles of a pixel's halves

float pixel_value(const Brdf& brdf, const Vec3f& s, int x, int y, int size) {
  float sum = 0;
  int inside = 0;
  for (const double dx : kHalves)
    for (const double dy : kHalves) {
      const Vec2d p = disk_point(x + dx, y + dy, size);
      if (dot(p, p) >= 1) continue;
      sum += finite_luminance(brdf(s, direction_of_disk(p))), ++inside;
    }
  return inside > 0 ? sum / float(inside) : std::numeric_limits<float>::quiet_NaN();
}

/// The share of a pixel that lies in the disk.
float coverage(int x, int y, int size) {
  float share = 0;
  for (const double dx : kHalves)
    for (const double dy : kHalves) {
      const Vec2d p = disk_point(x + dx, y + dy, size);
      share += dot(p, p) < 1 ? 0.25f : 0.0f;
    }
  return share;
}

}  // namespace

HemisphereMap hemisphere_map(const Brdf& brdf, double incident, double azimuth, int size) {
  HemisphereMap map{incident, azimuth, size, {}};
  const Vec3f s = slice_light(incident, azimuth);
  map.values.reserve(size_t(size) * size_t(size));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) map.values.push_back(pixel_value(brdf, s, x, y, size));
  const Vec2d p = disk_of_direction(mirrored(s));
  const auto pixel = [&](double v) { return std::clamp(int((v + 1) / 2 * size), 0, size - 1); };
  float& there = map.values[size_t(pixel(p.y)) * size_t(size) + size_t(pixel(-p.x))];
  const float mirror = finite_luminance(brdf(s, mirrored(s)));
  if (!(there > mirror)) there = mirror;
  return map;
}

float HeatScale::share(double value) const {
  if (!(value > 0)) return 0;
  return float(std::clamp((std::log10(value) - lowest) / (highest - lowest), 0.0, 1.0));
}

HeatScale heat_scale(const std::vector<HemisphereMap>& maps) {
  float least = std::numeric_limits<float>::infinity(), most = 0;
  for (const HemisphereMap& map : maps)
    for (const float v : map.values)
      if (v > 0) least = std::min(least, v), most = std::max(most, v);
  if (!(most > 0)) return {};
  HeatScale scale;
  scale.highest = int(std::ceil(std::log10(double(most))));
  scale.lowest =
      std::clamp(int(std::floor(std::log10(double(least)))), scale.highest - kMostDecades, scale.highest - 1);
  return scale;
}

ColorImage heat_picture(const HemisphereMap& map, const HeatScale& scale) {
  ColorImage picture{map.size, map.size, {"R", "G", "B", "A"}, {}};
  picture.pixels.reserve(map.values.size() * 4);
  for (size_t i = 0; i < map.values.size(); ++i) {
    const float v = map.values[i];
    const Rgb c = std::isnan(v) ? Rgb{} : heat_color(scale.share(double(v)));
    picture.pixels.insert(picture.pixels.end(),
                          {c.r, c.g, c.b, coverage(int(i) % map.size, int(i) / map.size, map.size)});
  }
  return picture;
}

}  // namespace alhazen
