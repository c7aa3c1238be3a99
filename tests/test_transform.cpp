#include <gtest/gtest.h>

#include <random>

#include "core/transform.h"

namespace alhazen {
namespace {

Affine3d random_affine(std::mt19937& rng) {
  std::uniform_real_distribution<double> u(-2, 2);
  const auto v = [&] { return Vec3d{u(rng), u(rng), u(rng)}; };
  return {v(), v(), v(), v()};
}

TEST(Transform, InverseUndoesTheMap) {
  std::mt19937 rng(1);
  for (int i = 0; i < 10000; ++i) {
    const Affine3d m = random_affine(rng);
    if (std::abs(determinant(m)) < 1e-2) continue;
    const Vec3d p = random_affine(rng).origin, q = transform_point(inverse(m) * m, p);
    EXPECT_LT(length(q - p), 1e-10);
  }
}

TEST(Transform, NormalsStayPerpendicularToTangentsAndOnTheirSide) {
  std::mt19937 rng(2);
  for (int i = 0; i < 10000; ++i) {
    const Affine3d m = random_affine(rng);
    if (std::abs(determinant(m)) < 1e-2) continue;
    const Vec3d a = random_affine(rng).x, b = random_affine(rng).x, n = cross(a, b);
    const Vec3d n_world = transform_normal(m, n);
    EXPECT_NEAR(dot(n_world, transform_vector(m, a)), 0, 1e-11);
    EXPECT_NEAR(dot(n_world, transform_vector(m, b)), 0, 1e-11);
    EXPECT_GT(dot(n_world, transform_vector(m, n)), 0);  // also under mirrors
  }
}

}  // namespace
}  // namespace alhazen
