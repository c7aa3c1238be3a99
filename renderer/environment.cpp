#include "renderer/environment.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/fork_join.h"
#include "core/lane_memory.h"
#include "core/sampling.h"
#include "materials/microfacet.h"
#include "materials/texture.h"
#include "renderer/equirectangular.h"

namespace alhazen {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kLevels = 6;

Rgb pixel(const ColorImage& image, int x, int y) {
  const float* p = image.at(x, y);
  return {p[0], p[1], p[2]};
}

Rgb bilinear(const ColorImage& image, const Vec2f& place) {
  const auto [u, v] = place;
  const float x = u * float(image.width) - 0.5f, y = v * float(image.height) - 0.5f;
  const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
  const auto column = [&](int k) { return k < 0 ? image.width - 1 : k >= image.width ? 0 : k; };  // one beyond at most
  const auto row = [&](int k) { return std::clamp(k, 0, image.height - 1); };
  const float s = x - float(x0), t = y - float(y0);
  return lerp(lerp(pixel(image, column(x0), row(y0)), pixel(image, column(x0 + 1), row(y0)), s),
              lerp(pixel(image, column(x0), row(y0 + 1)), pixel(image, column(x0 + 1), row(y0 + 1)), s), t);
}

ColorImage blank(int width, int height) {
  return {width, height, {"R", "G", "B"}, std::vector<float>(size_t(width) * size_t(height) * 3)};
}

void set_pixel(ColorImage& image, int x, int y, const Rgb& c) {
  float* p = image.at(x, y);
  p[0] = c.r, p[1] = c.g, p[2] = c.b;
}

template <class Color>
void fill(ColorImage& image, const Color& color) {
  const ForkJoin order;
  tbb::parallel_for(0, image.height, order.task([&](int y) {
    for (int x = 0; x < image.width; ++x) set_pixel(image, x, y, color(x, y));
  }));
}

/// Boxes of 2 x 2 pixels; an odd last row or column counts twice.
ColorImage halved(const ColorImage& image) {
  ColorImage half = blank(std::max(1, image.width / 2), std::max(1, image.height / 2));
  fill(half, [&](int x, int y) {
    const int x1 = std::min(2 * x + 1, image.width - 1), y1 = std::min(2 * y + 1, image.height - 1);
    const int x0 = std::min(2 * x, x1), y0 = std::min(2 * y, y1);
    return (pixel(image, x0, y0) + pixel(image, x1, y0) + pixel(image, x0, y1) + pixel(image, x1, y1)) * 0.25f;
  });
  return half;
}

/// Each a quarter of the one before, down to a few pixels.
std::vector<ColorImage> pyramid(const ColorImage& image) {
  std::vector<ColorImage> all{image};
  while (all.back().width > 8) all.push_back(halved(all.back()));
  return all;
}

/// One direction of a lobe about z.
struct LobeSample {
  Vec3f direction;  // unit
  int level;        // of the pyramid: looks as widely as the sample stands for
  float weight;     // of all samples: 1 together
};

/// A GGX lobe about the normal, seen along it: facets are sampled (Karis 2013; Krivanek and Colbert, "Real-time Shading
/// with Filtered Importance Sampling", 2008). `levels` are the pyramid's, `pixels` those of its first.
std::vector<LobeSample> lobe_samples(float roughness, int levels, int pixels) {
  constexpr uint32_t kSamples = 64;
  const float a2 = roughness * roughness * roughness * roughness;
  const float pixel_angle = 4 * kPi / float(pixels);
  std::vector<LobeSample> samples;
  float sum = 0;
  for (uint32_t i = 0; i < kSamples; ++i) {
    const Vec2f u = sobol_owen(i, 0);
    const float cos_h = std::sqrt((1 - u.x) / (1 + (a2 - 1) * u.x)),
                sin_h = std::sqrt(std::max(0.0f, 1 - cos_h * cos_h));
    const Vec3f h{sin_h * std::cos(2 * kPi * u.y), sin_h * std::sin(2 * kPi * u.y), cos_h};
    const Vec3f d = 2 * cos_h * h - Vec3f{0, 0, 1};
    if (!(d.z > 0)) continue;
    const float q = 1 + (a2 - 1) * cos_h * cos_h;
    const float probability = a2 / (kPi * q * q) / 4;  // of d: n·h = v·h here
    const float level = 0.5f * std::log2(std::max(1.0f, 4 / (float(kSamples) * probability * pixel_angle)));
    samples.push_back({d, std::min(int(level), levels - 1), d.z});
    sum += d.z;
  }
  for (LobeSample& sample : samples) sample.weight /= sum;
  return samples;
}

/// The radiance that the lobe gathers about r.
Rgb gathered(const std::vector<ColorImage>& levels, const std::vector<LobeSample>& lobe, const Vec3f& r) {
  const ShadingFrame frame = frame_about(r);
  Rgb sum;
  for (const LobeSample& sample : lobe) {
    const Vec3f& d = sample.direction;
    sum +=
        bilinear(levels[size_t(sample.level)], equirectangular_place(frame.t * d.x + frame.b * d.y + frame.n * d.z)) *
        sample.weight;
  }
  return sum;
}

std::array<Rgb, 9> projected(const ColorImage& image) {
  std::array<Vec3d, 9> sum{};
  for (int y = 0; y < image.height; ++y) {
    const float theta = (float(y) + 0.5f) / float(image.height) * kPi;
    const double angle = double(std::sin(theta) * 2 * kPi * kPi / float(image.width * image.height));
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = pixel(image, x, y);
      const auto basis = harmonics_at(equirectangular_direction(x, y, image.width, image.height));
      for (size_t k = 0; k < 9; ++k)
        sum[k] += Vec3d(double(c.r), double(c.g), double(c.b)) * (angle * double(basis[k]));
    }
  }
  std::array<Rgb, 9> harmonics;
  for (size_t k = 0; k < 9; ++k) harmonics[k] = {float(sum[k].x), float(sum[k].y), float(sum[k].z)};
  return harmonics;
}

float smooth_edge(float x, float from, float to) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// A rectangle of light seen from its middle's direction: 1 inside, soft at the edges.
float soft_box(const Vec3f& d, const Vec3f& middle, float half_width, float half_height) {
  const Vec3f z = normalize(middle), x = normalize(cross(Vec3f{0, 1, 0}, z)), y = cross(z, x);
  const float depth = dot(d, z);
  if (!(depth > 0)) return 0;
  const float u = std::abs(dot(d, x) / depth), v = std::abs(dot(d, y) / depth);
  return smooth_edge(half_width - u, -0.06f, 0.06f) * smooth_edge(half_height - v, -0.06f, 0.06f);
}

Rgb studio_radiance(const Vec3f& d) {
  const float height = d.y;
  Rgb c = lerp(Rgb{0.07f, 0.072f, 0.075f}, Rgb{0.18f, 0.182f, 0.185f}, smooth_edge(height, -0.2f, 0.9f));
  c = lerp(c, Rgb{0.17f, 0.165f, 0.16f}, smooth_edge(-height, 0.15f, 0.6f));  // the floor
  c += Rgb{2.4f, 2.35f, 2.28f} * soft_box(d, {-0.8f, 0.75f, 0.55f}, 0.45f, 0.35f);
  c += Rgb{0.8f, 0.84f, 0.9f} * soft_box(d, {1.0f, 0.25f, 0.5f}, 0.25f, 0.6f);
  c += Rgb{1.6f} * soft_box(d, {0.45f, 0.5f, -0.9f}, 0.5f, 0.12f);
  return c;
}

}  // namespace

Environment make_environment(ColorImage image) {
  Environment environment;
  const std::vector<ColorImage> source = pyramid(image);
  // Degree 2 needs no more than some dozens of pixels.
  const auto small = std::find_if(source.begin(), source.end(), [](const ColorImage& i) { return i.width <= 128; });
  environment.harmonics = projected(small == source.end() ? source.back() : *small);
  environment.levels.push_back(std::move(image));
  for (int k = 1; k < kLevels; ++k) {
    const int width = std::max(32, 256 >> k);
    ColorImage level = blank(width, width / 2);
    const auto lobe = lobe_samples(float(k) / (kLevels - 1), int(source.size()), source[0].width * source[0].height);
    fill(level,
         [&](int x, int y) { return gathered(source, lobe, equirectangular_direction(x, y, width, width / 2)); });
    environment.levels.push_back(std::move(level));
  }
  return environment;
}

namespace {

/// Bilinear look-ups of a level of its own in each lane.
template <class F>
BasicRgb<F> looked_up(const std::vector<ColorImage>& levels, const IntOf<F>& level, const Vec2<F>& place) {
  using I = IntOf<F>;
  LaneArray<I> numbers, widths, heights;
  LaneArray<AddressOf<F>> addresses;
  numbers.store(level);
  for (size_t k = 0; k < kWidthOf<F>; ++k) {
    const ColorImage& image = levels[size_t(numbers[k])];
    widths[k] = image.width, heights[k] = image.height;
    addresses[k] = reinterpret_cast<uintptr_t>(image.pixels.data());
  }
  const I width = widths.load(), height = heights.load(), last_column = width - I(1), last_row = height - I(1);
  const F x = place.x * convert<F>(width) - F(0.5f), y = place.y * convert<F>(height) - F(0.5f);
  // One texel beyond the edges at most: x and y are at least -0.5.
  const I x0 = convert<I>(F(x + F(1))) - I(1), y0 = convert<I>(F(y + F(1))) - I(1);
  const F s = x - convert<F>(x0), t = y - convert<F>(y0);
  const I left = select(x0 < I(0), last_column, select(x0 > last_column, I(0), x0));
  const I right = select(x0 >= last_column, I(0), I(larger(x0, I(-1)) + I(1)));
  const I above = smaller(larger(y0, I(0)), last_row), below = smaller(I(larger(y0, I(-1)) + I(1)), last_row);
  const AddressOf<F> pixels = addresses.load();
  const auto at = [&](const I& column, const I& row) {
    const AddressOf<F> red = pixels + (convert<AddressOf<F>>(I((row * width + column) * I(3))) << 2);
    const AddressOf<F> green = red + AddressOf<F>(sizeof(float)), blue = green + AddressOf<F>(sizeof(float));
    return BasicRgb<F>{load_at<F>(red), load_at<F>(green), load_at<F>(blue)};
  };
  return lerp(lerp(at(left, above), at(right, above), s), lerp(at(left, below), at(right, below), s), t);
}

}  // namespace

template <class F>
BasicRgb<F> environment_radiance(const Environment& environment, const Vec3<F>& direction_world,
                                 std::type_identity_t<F> roughness) noexcept {
  using I = IntOf<F>;
  const Vec2<F> place = equirectangular_place(rotated(environment.environment_from_world, direction_world));
  const I last(int(environment.levels.size() - 1));
  const F level = clamped(roughness, 0, 1) * convert<F>(last);
  const I sharp = smaller(convert<I>(level), last);
  const F fraction = level - convert<F>(sharp), strength(environment.strength);
  const BasicRgb<F> first = looked_up(environment.levels, sharp, place);
  if (!any_of(fraction > F(0))) return first * strength;
  const I blurred = smaller(I(sharp + I(1)), last);
  return lerp(first, looked_up(environment.levels, blurred, place), fraction) * strength;
}

template Rgb environment_radiance(const Environment&, const Vec3f&, float) noexcept;
template BasicRgb<ShadingLanes> environment_radiance(const Environment&, const Vec3<ShadingLanes>&,
                                                     ShadingLanes) noexcept;

Environment studio_environment(const Vec3d& forward_world) {
  constexpr int kWidth = 256;
  ColorImage image = blank(kWidth, kWidth / 2);
  fill(image, [](int x, int y) { return studio_radiance(equirectangular_direction(x, y, kWidth, kWidth / 2)); });
  Environment environment = make_environment(std::move(image));
  environment.seen = false;
  // Turned about y until the studio's +z points at the camera.
  Vec3d z{-forward_world.x, 0, -forward_world.z};
  if (!(dot(z, z) > 1e-12)) z = {0, 0, 1};
  z = normalize(z);
  const Vec3d x = cross(Vec3d{0, 1, 0}, z);
  // Rows of the rotation from the world are the studio's axes in it.
  environment.environment_from_world = {{float(x.x), 0, float(z.x)}, {0, 1, 0}, {float(x.z), 0, float(z.z)}, {}};
  return environment;
}

}  // namespace alhazen
