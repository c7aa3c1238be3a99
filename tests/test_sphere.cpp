#include <gtest/gtest.h>

#include <random>

#include "accel/shapes/sphere.h"

namespace alhazen {
namespace {

Vec3d random_unit(std::mt19937& rng) {
  std::normal_distribution<double> g;
  return normalize(Vec3d{g(rng), g(rng), g(rng)});
}

TEST(Sphere, HitPointLiesOnTheSurfaceAtAnyDistanceAndScale) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 100000; ++i) {
    const Sphere sphere{float(std::pow(10, 8 * u(rng) - 4))};
    const double r = sphere.radius, distance = r * std::pow(10, 4 * u(rng));
    const Vec3d origin = random_unit(rng) * distance, target = random_unit(rng) * (r * 0.9 * u(rng));
    const Rayd ray{origin, (target - origin) * std::pow(2, 20 * u(rng) - 10)};
    const Crossings c = crossings(sphere, ray);
    ASSERT_EQ(c.count, 2);
    for (const double t : c.t) EXPECT_NEAR(length(point_at(ray, t)) / r, 1, 1e-10);
    EXPECT_LE(c.t[0], c.t[1]);
  }
}

TEST(Sphere, IsMissedByTangentsZeroDirectionsAndNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(crossings(Sphere{5}, Rayd{{3, 4, 0}, {4, -3, 0}}).count, 0);
  EXPECT_EQ(crossings(Sphere{5}, Rayd{{5, 0, -7}, {0, 0, 1}}).count, 0);
  EXPECT_EQ(crossings(Sphere{1}, Rayd{{0, 0, 0}, {0, 0, 0}}).count, 0);
  EXPECT_EQ(crossings(Sphere{1}, Rayd{{nan, 0, 0}, {0, 0, 1}}).count, 0);
  EXPECT_EQ(crossings(Sphere{1}, Rayd{{0, 0, -3}, {0, nan, 1}}).count, 0);
}

TEST(Sphere, FromItsCentreIsLeftAtOneRadius) {
  const Crossings c = crossings(Sphere{2}, Rayd{{0, 0, 0}, {0, 0, 0.5}});
  ASSERT_EQ(c.count, 2);
  EXPECT_EQ(c.t[0], -4);
  EXPECT_EQ(c.t[1], 4);
}

}  // namespace
}  // namespace alhazen
