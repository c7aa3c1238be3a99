#include "reflectance/lit_sphere.h"

#include <numbers>
#include <optional>

#include "reflectance/directions.h"

namespace alhazen {
namespace {

constexpr float kLamp = std::numbers::pi_v<float>, kSky = 0.15f;
constexpr float kGround = 0.02f, kFurnaceExposure = 0.5f;
constexpr double kRadius = 0.92;  // of half the picture
constexpr int kSubpixels = 3;     // across
const Vec3f kToLamp = normalize(Vec3f(-0.55f, 0.6f, 0.6f));

/// The furnace's light towards an eye under that angle, between those that were integrated.
Rgb furnace_light(const BrdfCheck& check, double degrees) {
  const auto& points = check.albedo;
  size_t i = 1;
  while (i + 1 < points.size() && points[i].degrees < degrees) ++i;
  const auto &a = points[i - 1], &b = points[i];
  const double share = std::clamp((degrees - a.degrees) / (b.degrees - a.degrees), 0.0, 1.0);
  return lerp(a.furnace.value, b.furnace.value, float(share));
}

/// The ball's normal at a point of the picture's square, x right, y up, z to the eye.
std::optional<Vec3f> normal_at(double x, double y) {
  const double r2 = x * x + y * y;
  if (r2 >= 1) return std::nullopt;
  return Vec3f(Vec3d(x, y, std::sqrt(1 - r2)));
}

/// light(normal), or the ground where there is none; the mean over each pixel.
template <class F>
ColorImage sphere_picture(int size, const Rgb& ground, const F& light) {
  ColorImage picture{size, size, {"R", "G", "B", "A"}, {}};
  const auto at = [&](double pixel) { return (2 * pixel / size - 1) / kRadius; };
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      Rgb sum;
      for (int k = 0; k < kSubpixels * kSubpixels; ++k) {
        const double dx = (k % kSubpixels + 0.5) / kSubpixels, dy = (k / kSubpixels + 0.5) / kSubpixels;
        const auto n = normal_at(at(x + dx), -at(y + dy));
        const Rgb c = n ? light(*n) : ground;
        // Clipped before they are averaged: else a highlight's edge is jagged.
        sum += Rgb(std::min(c.r, 1.0f), std::min(c.g, 1.0f), std::min(c.b, 1.0f));
      }
      const Rgb mean = sum * (1.0f / (kSubpixels * kSubpixels));
      picture.pixels.insert(picture.pixels.end(), {mean.r, mean.g, mean.b, 1.0f});
    }
  return picture;
}

}  // namespace

ColorImage lit_sphere(const Subject& subject, const BrdfCheck& check, int size) {
  return sphere_picture(size, Rgb(kGround), [&](const Vec3f& n) {
    const Vec3f across(n.z, 0, -n.x);  // round the vertical axis
    const Vec3f t = dot(across, across) > 0 ? normalize(across) : Vec3f(1, 0, 0), b = cross(n, t);
    const auto local = [&](const Vec3f& d) { return Vec3f(dot(d, t), dot(d, b), dot(d, n)); };
    const Vec3f s = local(kToLamp), eye = local({0, 0, 1});
    const Rgb value = subject.brdf(s, eye);
    const Rgb lamp = is_finite(value) ? value * (kLamp * std::max(0.0f, s.z)) : Rgb{};
    return lamp + furnace_light(check, theta_of(eye)) * kSky;
  });
}

ColorImage furnace_sphere(const BrdfCheck& check, int size) {
  return sphere_picture(size, Rgb(kFurnaceExposure),
                        [&](const Vec3f& n) { return furnace_light(check, theta_of(n)) * kFurnaceExposure; });
}

}  // namespace alhazen
