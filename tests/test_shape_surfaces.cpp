// What is found at a point of a shape: normals, texture coordinates; and the stated answers for degenerate cases.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "accel/shape_hits.h"

namespace alhazen {
namespace {

std::vector<ShapeHit> hits_of(const Shape& shape, const Vec3f& origin, const Vec3f& direction,
                              const Affine3d& world_from_object = {}) {
  std::vector<ShapeHit> hits;
  append_hits({line_map(world_from_object), &world_from_object, &shape}, {origin, direction}, hits);
  return hits;
}

std::vector<float> parameters(const Shape& shape, const Vec3f& origin, const Vec3f& direction) {
  std::vector<float> t;
  for (const ShapeHit& hit : hits_of(shape, origin, direction)) t.push_back(hit.t);
  return t;
}

using Parameters = std::vector<float>;

Quadric quadric(const std::array<double, 10>& coefficients, bool solid = false) {
  Quadric q;
  q.coefficients = coefficients, q.solid = solid;
  q.box = {{-2, -2, -2}, {2, 2, 2}};
  return q;
}

/// Gradient and parametric derivatives must give one normal. `point` maps parameters to the surface.
template <class S, class Point>
void expect_normal_is_cross_product(const S& shape, int face, const Point& point, double u, double v) {
  const double h = 1e-6;
  const Vec3d du = (point(u + h, v) - point(u - h, v)) / (2 * h), dv = (point(u, v + h) - point(u, v - h)) / (2 * h);
  const Vec3d crossed = normalize(cross(du, dv)), n = normal(shape, point(u, v), face);
  EXPECT_NEAR(std::abs(dot(crossed, n)), 1, 1e-8);
  EXPECT_NEAR(length(n), 1, 1e-12);
}

TEST(ShapeNormals, OfTheGradientAndOfParametricDerivativesAgree) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(0.1, 0.9);
  const double pi = std::numbers::pi;
  for (int k = 0; k < 1000; ++k) {
    const double u = unit(rng), v = unit(rng), r = unit(rng), h = unit(rng), s = unit(rng);
    expect_normal_is_cross_product(
        Sphere{r}, kWallFace,
        [&](double a, double b) {
          return Vec3d{r * std::sin(pi * b) * std::sin(2 * pi * a), r * std::cos(pi * b),
                       r * std::sin(pi * b) * std::cos(2 * pi * a)};
        },
        u, v);
    expect_normal_is_cross_product(
        Cylinder{h, r, s, true}, kWallFace,
        [&](double a, double b) {
          const double radius = r + (s - r) * b;
          return Vec3d{radius * std::sin(2 * pi * a), h * (b - 0.5), radius * std::cos(2 * pi * a)};
        },
        u, v);
    // The saddle y = r x² - s z².
    expect_normal_is_cross_product(
        quadric({r, 0, -s, 0, 0, 0, 0, -0.5, 0, 0}), kWallFace,
        [&](double a, double b) {
          return Vec3d{a, r * a * a - s * b * b, b};
        },
        u, v);
  }
}

TEST(Cone, HasEveryPointBesideItsApexOnItsWallAndNotWithin) {
  const Cylinder cone{2, 1, 0, true};  // apex at y = 1
  for (const double y : {-1.0, 0.0, 0.9, 1 - 0x1p-20, 1.0}) {
    const Vec3d p = project(cone, {0, y, 0}, kWallFace);  // as of a hit that rounds onto the axis
    EXPECT_DOUBLE_EQ(std::hypot(p.x, p.z), (1 - y) / 2) << y;
    EXPECT_GT(dot(normal(cone, p, kWallFace), p - Vec3d{0, -1, 0}), 0) << y;
  }
  EXPECT_EQ(normal(cone, project(cone, {0, 1, 0}, kWallFace), kWallFace), (Vec3d{0, 1, 0}));
}

TEST(ShapeTextureCoordinates, AreAsTheFormatStates) {
  const auto expect = [](const Vec2f& uv, float u, float v) {
    EXPECT_NEAR(uv.x, u, 1e-6f);
    EXPECT_NEAR(uv.y, v, 1e-6f);
  };
  expect(texture_coordinates(Sphere{2}, {0, 0, 2}, kWallFace), 0.5f, 0.5f);
  expect(texture_coordinates(Sphere{2}, {2, 0, 0}, kWallFace), 0.75f, 0.5f);
  expect(texture_coordinates(Sphere{2}, {0, 2, 0}, kWallFace), 0.5f, 0);
  expect(texture_coordinates(Cylinder{4, 1, 1, true}, {0, 1, 1}, kWallFace), 0.5f, 0.25f);
  expect(texture_coordinates(Cylinder{4, 1, 2, true}, {1, 2, -1}, 3), 0.75f, 0.25f);
  expect(texture_coordinates(Disk{2, 1}, {1, 0, 1}, 3), 0.75f, 0.75f);
  const Box box{{2, 4, 6}};
  expect(texture_coordinates(box, {0.5, 1, 3}, 5), 0.75f, 0.25f);     // +z: right +x, up +y
  expect(texture_coordinates(box, {0.5, 1, -3}, 4), 0.25f, 0.25f);    // -z: right -x
  expect(texture_coordinates(box, {1, 1, 1.5}, 1), 0.25f, 0.25f);     // +x: right -z
  expect(texture_coordinates(box, {-1, 1, 1.5}, 0), 0.75f, 0.25f);    // -x: right +z
  expect(texture_coordinates(box, {0.5, 2, 1.5}, 3), 0.75f, 0.75f);   // +y: up -z
  expect(texture_coordinates(box, {0.5, -2, 1.5}, 2), 0.75f, 0.25f);  // -y: up +z
  expect(texture_coordinates(quadric({0, 0, 0, 0, 0, 0, 0, 1, 0, 0}), {1, 0, -1}, kWallFace), 0.75f, 0.25f);
}

TEST(Sphere, IsTouchedOnceByATangentAndMissedBesideIt) {
  EXPECT_EQ(parameters(Sphere{5}, {3, 4, -7}, {0, 0, 1}), (Parameters{7, 7}));
  EXPECT_EQ(parameters(Sphere{5}, {3, std::nextafter(4.0f, 5.0f), -7}, {0, 0, 1}), Parameters{});
  EXPECT_EQ(parameters(Sphere{5}, {3, std::nextafter(4.0f, 0.0f), -7}, {0, 0, 1}).size(), 2u);
}

TEST(Sphere, OfTheSizeOfAPlanetIsHitOneUnitBelow) {
  EXPECT_EQ(parameters(Sphere{1e9}, {0, 1000000064, 0}, {0, -1, 0})[0], 64.0f);
}

TEST(Sphere, AtAMillionRadiiIsHitExactlyWhereTheDiscriminantSays) {
  const Affine3d far{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1e6, 0, 0}};
  EXPECT_EQ(hits_of(Sphere{1}, {0, 1, 0}, {1, 0, 0}, far).size(), 2u);
  EXPECT_EQ(hits_of(Sphere{1}, {0, std::nextafter(1.0f, 2.0f), 0}, {1, 0, 0}, far).size(), 0u);
  EXPECT_EQ(hits_of(Sphere{1}, {0, std::nextafter(1.0f, 0.0f), 0}, {1, 0, 0}, far).size(), 2u);
}

TEST(Cylinder, AlongItsAxisIsHitOnTheCapsAlone) {
  EXPECT_EQ(parameters(Cylinder{2, 1, 1, true}, {0.5f, 4, 0}, {0, -1, 0}), (Parameters{3, 5}));
  EXPECT_EQ(parameters(Cylinder{2, 1, 1, false}, {0.5f, 4, 0}, {0, -1, 0}), Parameters{});
  EXPECT_EQ(parameters(Cylinder{2, 1, 1, true}, {1, 4, 0}, {0, -1, 0}), (Parameters{3, 5}));  // within the wall
  EXPECT_EQ(parameters(Cylinder{2, 1, 1, true}, {std::nextafter(1.0f, 2.0f), 4, 0}, {0, -1, 0}), Parameters{});
}

TEST(Cone, ShowsOneNappeAndItsApex) {
  const Cylinder cone{2, 1, 0, true};                                      // apex at y = 1
  EXPECT_EQ(parameters(cone, {0, 1, -3}, {0, 0, 1}), (Parameters{3, 3}));  // through the apex
  EXPECT_EQ(parameters(cone, {0, 1.5f, -3}, {0, 0, 1}), Parameters{});     // where the other nappe would be
  EXPECT_EQ(parameters(cone, {0, 5, 0}, {0, -1, 0}), (Parameters{4, 6}));  // down the axis
  EXPECT_EQ(parameters(cone, {0, 0, -3}, {0, 0, 1}), (Parameters{2.5f, 3.5f}));
}

TEST(Cone, AlongAGeneratorIsEnteredAtTheApexAndLeftAtTheRim) {
  // From beyond the apex down the line (0, 1, 0) + s (0, -2, 1), which lies in the wall.
  EXPECT_EQ(parameters(Cylinder{2, 1, 0, true}, {0, 3, -1}, {0, -2, 1}), (Parameters{1, 2}));
  EXPECT_EQ(parameters(Cylinder{2, 1, 0, false}, {0, 3, -1}, {0, -2, 1}), Parameters{});
}

TEST(Disk, IsMissedInItsPlaneAndClosedAtItsRims) {
  const Disk ring{2, 1};
  EXPECT_EQ(parameters(ring, {-5, 0, 0}, {1, 0, 0}), Parameters{});
  for (const float x : {1.0f, 1.5f, 2.0f}) EXPECT_EQ(parameters(ring, {x, 3, 0}, {0, -1, 0}), Parameters{3}) << x;
  for (const float x : {0.0f, std::nextafter(1.0f, 0.0f), std::nextafter(2.0f, 3.0f)})
    EXPECT_EQ(parameters(ring, {x, 3, 0}, {0, -1, 0}), Parameters{}) << x;
}

TEST(Box, IsClosedAtItsFacesEdgesAndCorners) {
  const Box box{{2, 2, 2}};
  EXPECT_EQ(parameters(box, {-3, 1, 0}, {1, 0, 0}), (Parameters{2, 4}));    // within a face
  EXPECT_EQ(parameters(box, {-3, 1, 1}, {1, 0, 0}), (Parameters{2, 4}));    // along an edge
  EXPECT_EQ(parameters(box, {-3, 3, 3}, {1, -1, -1}), (Parameters{2, 4}));  // corner to corner
  EXPECT_EQ(parameters(box, {-3, std::nextafter(1.0f, 2.0f), 0}, {1, 0, 0}), Parameters{});
}

TEST(Quadric, DegenerateClassesHaveTheirStatedAnswers) {
  const Vec3f from{-4, 0.5f, 0.25f}, along{1, 0, 0};
  EXPECT_EQ(parameters(quadric({1, 0, 0, 0, 0, 0, 0, 0, 0, 0}), from, along), Parameters{4});        // double plane
  EXPECT_EQ(parameters(quadric({1, 0, 0, 0, 0, 0, 0, 0, 0, -1}), from, along), (Parameters{3, 5}));  // two planes
  EXPECT_EQ(parameters(quadric({0, 0, 0, 0, 0, 0, 1, 0, 0, -2}), from, along), Parameters{5});       // x = 1
  EXPECT_EQ(parameters(quadric({0, 0, 0, 1, 0, 0, 0, 0, 0, 0}), from, along), Parameters{4});        // x y = 0
  EXPECT_EQ(parameters(quadric({1, 1, 1, 0, 0, 0, 0, 0, 0, 1}), from, along), Parameters{});         // empty
  EXPECT_EQ(parameters(quadric({1, 1, 0, 0, 0, 0, 0, 0, 0, 0}), from, along), Parameters{});         // a line
  EXPECT_EQ(parameters(quadric({0, 0, 0, 0, 0, 0, 0, 0, 0, 1}), from, along), Parameters{});         // never 0
  EXPECT_EQ(parameters(quadric({0, 0, 0, 0, 0, 0, 0, 0, 1, -0.5}), from, along), Parameters{});      // in its plane
}

TEST(Quadric, TimesAnyFactorIsTheSameSurface) {
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 300; ++k) {
    std::array<double, 10> q;
    for (double& c : q) c = std::ldexp(std::round(unit(rng) * 1024), -10);  // so that the factors scale them exactly
    const auto v = [&] { return Vec3f{float(unit(rng)), float(unit(rng)), float(unit(rng))}; };
    const Vec3f origin = v() * 4.0f, direction = v();
    const Parameters expected = parameters(quadric(q), origin, direction);
    for (const double factor : {0x1p-66, -1.0, -0x1p-100, 0x1p66, 0x1p100}) {
      auto scaled = q;
      for (double& c : scaled) c *= factor;
      EXPECT_EQ(parameters(quadric(scaled), origin, direction), expected) << "factor " << factor;
    }
  }
}

TEST(Quadric, OfADoublePlaneHasThatPlanesNormal) {
  const Vec3d n = normal(quadric({1, 0, 0, 0, 0, 0, 0, 0, 0, 0}), {1e-17, 0.3, 0.2}, kWallFace);
  EXPECT_EQ(std::abs(n.x), 1);
}

TEST(Quadric, SolidIsCutByItsBoxWithFlatCaps) {
  Quadric q = quadric({1, 0, 1, 0, 0, 0, 0, 0, 0, -1}, true);  // a cylinder about y
  const auto hits = hits_of(q, {0.5f, 5, 0}, {0, -1, 0});
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_EQ(hits[0].t, 3);
  EXPECT_EQ(hits[0].face, 3u);
  EXPECT_EQ(hits[1].t, 7);
  EXPECT_EQ(hits[1].face, 2u);
  q.solid = false;
  EXPECT_TRUE(hits_of(q, {0.5f, 5, 0}, {0, -1, 0}).empty());
}

TEST(Composite, OfCoincidentFacesHasNoSkinBetween) {
  using Operation = CompositeNode::Operation;
  const Affine3d up{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 0}};
  const CompositeOperand stacked[] = {{Box{{1, 1, 1}}, {}}, {Box{{1, 1, 1}}, up}};
  EXPECT_EQ(parameters(make_composite(Operation::unite, stacked), {0.1f, 3, 0.2f}, {0, -1, 0}),
            (Parameters{1.5f, 3.5f}));
  EXPECT_EQ(parameters(make_composite(Operation::intersect, stacked), {0.1f, 3, 0.2f}, {0, -1, 0}), Parameters{});
  const CompositeOperand same[] = {{Box{{1, 1, 1}}, {}}, {Box{{1, 1, 1}}, {}}};
  EXPECT_EQ(parameters(make_composite(Operation::subtract, same), {0.1f, 3, 0.2f}, {0, -1, 0}), Parameters{});
}

TEST(Composite, OfBodiesInOnePlaceIsDecidedInDouble) {
  // A body and itself are met at the same time: nobody has to compute at what time with more digits.
  using Operation = CompositeNode::Operation;
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3f{float(unit(rng)), float(unit(rng)), float(unit(rng))}; };
  const Affine3d place{{1.1, 0.2, 0}, {0, 0.9, 0.1}, {0.3, 0, 1}, {0.1, 0.2, 0.3}},
      other{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.4, 0, 0}};
  const CompositeOperand twice[] = {
      {Sphere{0.7}, place}, {Box{{1, 1, 1}}, other}, {Sphere{0.7}, place}, {Box{{1, 1, 1}}, other}};
  const CompositeOperand once[] = {{Sphere{0.7}, place}, {Box{{1, 1, 1}}, other}};
  for (const Operation operation : {Operation::unite, Operation::intersect, Operation::subtract}) {
    const Composite doubled = make_composite(operation, twice), single = make_composite(operation, once);
    const uint64_t quad = doubt_counts().quad;
    for (int k = 0; k < 2000; ++k) {
      const Vec3f origin = vector() * 2.0f, direction = vector();
      const std::vector<float> expected =
          operation == Operation::subtract ? Parameters{} : parameters(single, origin, direction);
      EXPECT_EQ(parameters(doubled, origin, direction), expected);
    }
    EXPECT_LT(doubt_counts().quad - quad, 20u);  // a few graze an edge
  }
}

TEST(Composite, ReversesTheNormalWhereAnOperandIsSubtracted) {
  const CompositeOperand bubble[] = {{Box{{2, 2, 2}}, {}}, {Sphere{0.5}, {}}};
  const Composite cube = make_composite(CompositeNode::Operation::subtract, bubble);
  const auto hits = hits_of(cube, {0, 0, -3}, {0, 0, 1});
  ASSERT_EQ(hits.size(), 4u);
  EXPECT_EQ(normal(cube, {0, 0, -1}, int(hits[0].face)), (Vec3d{0, 0, -1}));
  EXPECT_EQ(normal(cube, {0, 0, -0.5}, int(hits[1].face)), (Vec3d{0, 0, 1}));  // into the bubble
}

TEST(Composite, CrossesALineWhereMembershipChanges) {
  using Operation = CompositeNode::Operation;
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const double r = 0.5 + 0.4 * unit(rng), s = 0.5 + 0.4 * unit(rng), x = 0.5 * unit(rng);
    const Affine3d moved{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {x, 0, 0}};
    const auto operation = Operation(1 + k % 3);
    const CompositeOperand operands[] = {{Sphere{r}, {}}, {Box{{2 * s, 2 * s, 2 * s}}, moved}};
    const auto inside = [&](const Vec3d& p) {
      const bool a = length(p) < r, b = max_component(abs(p - moved.origin)) < s;
      return operation == Operation::unite ? a || b : operation == Operation::intersect ? a && b : a && !b;
    };
    const auto v = [&] { return Vec3f{float(unit(rng)), float(unit(rng)), float(unit(rng))}; };
    const Vec3f origin = v() * 3.0f, direction = v();
    const Rayd ray{Vec3d(origin), Vec3d(direction)};
    bool in = inside(ray.origin);
    double before = 0;
    std::vector<float> t = parameters(make_composite(operation, operands), origin, direction);
    t.push_back(100);
    for (const float after : t) {
      if (double(after) - before > 1e-5) {
        EXPECT_EQ(inside(point_at(ray, (before + double(after)) / 2)), in) << "case " << k;
      }
      before = double(after), in = !in;
    }
  }
}

}  // namespace
}  // namespace alhazen
