#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "accel/accelerated_scene.h"
#include "accel/shape_hits.h"

namespace alhazen {
namespace {

class Random {
 public:
  explicit Random(uint64_t seed) : rng_(seed) {}
  double uniform(double lower = -1, double upper = 1) {
    return std::uniform_real_distribution<double>(lower, upper)(rng_);
  }
  /// Between 10^lower and 10^upper.
  double decades(double lower, double upper) { return std::pow(10, uniform(lower, upper)); }
  Vec3d in_cube(double half = 1) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  bool coin() { return uniform() > 0; }

 private:
  std::mt19937_64 rng_;
};

/// Rotation, shear, non-uniform scale, often mirrored; translated by up to ten sizes.
Affine3d random_map(Random& random) {
  const double scale = random.decades(-3, 3);
  Affine3d m;
  do {
    m = {random.in_cube(scale), random.in_cube(scale), random.in_cube(scale), random.in_cube(10 * scale)};
  } while (std::abs(determinant(m)) < 0.02 * scale * scale * scale);
  return m;
}

template <class S>
S random_shape(Random& random);
template <>
Sphere random_shape(Random& random) {
  return {random.decades(-2, 2)};
}
template <>
Cylinder random_shape(Random& random) {
  Cylinder c{random.decades(-2, 1), random.decades(-2, 1), random.decades(-2, 1), random.coin()};
  if (random.uniform(0, 1) < 0.3) (random.coin() ? c.radius_top : c.radius_bottom) = 0;
  return c;
}
template <>
Disk random_shape(Random& random) {
  const double r = random.decades(-2, 2);
  return {r, random.coin() ? 0 : r * random.uniform(0.1, 0.9)};
}
template <>
Box random_shape(Random& random) {
  return {{random.decades(-2, 1), random.decades(-2, 1), random.decades(-2, 1)}};
}
template <>
Polygon random_shape(Random& random) {
  // A star with a hole, in a random plane.
  const Vec3d x = random.in_cube(), y = random.in_cube();
  std::vector<std::vector<Vec3d>> loops(2);
  for (int k = 0; k < 9; ++k) {
    const double angle = 2 * std::numbers::pi * k / 9, outer = random.uniform(0.4, 1);
    loops[0].push_back(x * (outer * std::cos(angle)) + y * (outer * std::sin(angle)));
    loops[1].push_back(x * (0.3 * std::cos(angle)) + y * (0.3 * std::sin(angle)));
  }
  return make_polygon(loops);
}
template <>
Quadric random_shape(Random& random) {
  Quadric q;
  for (double& c : q.coefficients) c = random.uniform(0, 1) < 0.2 ? 0 : random.uniform();
  q.coefficients[9] *= 0.3;
  q.solid = random.coin();
  if (random.uniform(0, 1) > 0.3) return q;
  // A whole ellipsoid.
  for (size_t k = 0; k < 9; ++k) q.coefficients[k] = k < 3 ? random.uniform(1, 2) : 0.3 * q.coefficients[k];
  q.coefficients[9] = -random.uniform(0.1, 1);
  q.box = *ellipsoid_bounds(q.coefficients), q.whole = true;
  return q;
}
template <>
Composite random_shape(Random& random) {
  using Operation = CompositeNode::Operation;
  const auto body = [&]() -> ClosedBody {
    switch (int(random.uniform(0, 4))) {
      case 0:
        return Sphere{random.uniform(0.4, 1)};
      case 1:
        return Cylinder{random.uniform(0.5, 2), random.uniform(0.2, 1), random.uniform(0.2, 1), true};
      case 2:
        return Box{{random.uniform(0.5, 2), random.uniform(0.5, 2), random.uniform(0.5, 2)}};
      default: {
        Quadric q = random_shape<Quadric>(random);
        q.solid = true;
        return q;
      }
    }
  };
  const auto operation = [&] { return Operation(1 + int(random.uniform(0, 2.999))); };
  const auto map = [&] {
    Affine3d m{random.in_cube(), random.in_cube(), random.in_cube(), random.in_cube(0.4)};
    return std::abs(determinant(m)) > 0.1 ? m : Affine3d{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, random.in_cube(0.4)};
  };
  const CompositeOperand inner[] = {{body(), map()}, {body(), map()}, {body(), map()}};
  const CompositeOperand outer[] = {{make_composite(operation(), inner), map()}, {body(), map()}};
  return make_composite(operation(), outer);
}

/// A shape with a place, and rays that mostly meet it: from near and far, of any length, some along the axes.
struct Trial {
  Shape shape;
  Affine3d world_from_object;
  [[nodiscard]] PlacedShape placed() const { return {line_map(world_from_object), &world_from_object, &shape}; }
};

Rayf random_ray(const Trial& trial, Random& random) {
  const Bounds3d b = std::visit([](const auto& s) { return bounds(s); }, trial.shape);
  const Vec3d middle = (b.lower + b.upper) * 0.5, half = (b.upper - b.lower) * 0.5;
  const auto within = [&](double size) {
    const Vec3d v = random.in_cube(size);
    return middle + Vec3d{v.x * half.x, v.y * half.y, v.z * half.z};
  };
  const Vec3d from = transform_point(trial.world_from_object, within(random.decades(0, 1.5)));
  const Vec3d to = transform_point(trial.world_from_object, within(1.1));
  const double length = random.decades(-3, 3);
  Rayf ray{Vec3f(from), Vec3f((to - from) * length)};
  if (random.uniform(0, 1) < 0.1) ray.direction.x = 0;
  if (random.uniform(0, 1) < 0.1) ray.direction.y = 0;
  return ray;
}

std::vector<ShapeHit> exact_hits(const Trial& trial, const Rayf& ray) {
  const ExactLine line = exact_line({&trial.world_from_object, 1}, exact_line(ray));
  std::vector<ShapeHit> hits;
  for (const ExactCrossing& c : std::visit([&](const auto& s) { return exact_crossings(s, line); }, trial.shape)) {
    const float t = to_float(c.t);
    if (t >= ray.t_min && t <= ray.t_max) hits.push_back({t, uint32_t(c.face)});
  }
  return hits;
}

template <class S>
class Shapes : public testing::Test {
 public:
  Trial trial(Random& random) { return {random_shape<S>(random), random_map(random)}; }
};
using Kinds = testing::Types<Sphere, Cylinder, Disk, Box, Polygon, Quadric, Composite>;
TYPED_TEST_SUITE(Shapes, Kinds);

TYPED_TEST(Shapes, HitsAreThoseOfExactArithmetic) {
  Random random(1);
  int hits = 0, misrounded = 0;
  for (int k = 0; k < 150; ++k) {
    const Trial trial = this->trial(random);
    for (int i = 0; i < 20; ++i) {
      const Rayf ray = random_ray(trial, random);
      std::vector<ShapeHit> found;
      append_hits(trial.placed(), ray, found);
      const std::vector<ShapeHit> expected = exact_hits(trial, ray);
      ASSERT_EQ(found.size(), expected.size()) << "trial " << k << " ray " << i;
      for (size_t h = 0; h < found.size(); ++h) {
        EXPECT_EQ(found[h].face, expected[h].face);
        EXPECT_LE(std::abs(found[h].t - expected[h].t), std::abs(std::nextafter(expected[h].t, 0.0f) - expected[h].t));
        ++hits, misrounded += found[h].t != expected[h].t;
      }
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_LE(misrounded, hits / 10000);
}

TYPED_TEST(Shapes, BoundsContainEveryHit) {
  Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const Trial trial = this->trial(random);
    const Bounds3d b = std::visit([](const auto& s) { return bounds(s); }, trial.shape);
    const Vec3d margin = (abs(b.lower) + abs(b.upper)) * 1e-6;
    for (int i = 0; i < 20; ++i) {
      const Rayf ray = random_ray(trial, random);
      std::vector<ShapeHit> found;
      append_hits(trial.placed(), ray, found);
      for (const ShapeHit& hit : found) {
        const Vec3d p_near = map_point(line_map(trial.world_from_object),
                                       point_at(Rayd{Vec3d(ray.origin), Vec3d(ray.direction)}, double(hit.t)));
        const Vec3d p = std::visit([&](const auto& s) { return project(s, p_near, int(hit.face)); }, trial.shape);
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_GE(p[axis], b.lower[axis] - margin[axis]);
          EXPECT_LE(p[axis], b.upper[axis] + margin[axis]);
        }
      }
    }
  }
}

TYPED_TEST(Shapes, RaysThatAreNotRaysHitNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  Random random(3);
  const Trial trial = this->trial(random);
  for (const Rayf& ray :
       {Rayf{{0, 0, 0}, {0, 0, 0}}, Rayf{{nan, 0, 0}, {0, 0, 1}}, Rayf{{0, 0, 0}, {0, nan, 1}},
        Rayf{{0, inf, 0}, {0, 0, 1}}, Rayf{{0, 0, 0}, {inf, 0, 1}}, Rayf{{0, 0, 0}, {0, 0, 1}, 1, 0}}) {
    std::vector<ShapeHit> found;
    append_hits(trial.placed(), ray, found);
    EXPECT_TRUE(found.empty());
  }
}

TYPED_TEST(Shapes, PacketsAgreeWithAPlainLoopOverAllShapes) {
  Random random(4);
  Geometry geometry;
  for (uint32_t k = 0; k < 60; ++k) {
    geometry.shapes.push_back(random_shape<TypeParam>(random));
    Affine3d m = random_map(random);
    const double size = std::cbrt(std::abs(determinant(m)));
    m = {m.x / size, m.y / size, m.z / size, random.in_cube(2)};
    geometry.shape_instances.push_back({k, k, 0, m});
  }
  const AcceleratedScene accelerated(geometry, {});
  RayWave wave;
  wave.resize(10001);  // the last packet is not full
  for (size_t i = 0; i < wave.size(); ++i) wave.set(i, {Vec3f(random.in_cube(4)), Vec3f(random.in_cube())});
  HitWave hits;
  Lanes<Rgb> visible;
  for (const Coherence coherence : {Coherence::incoherent, Coherence::coherent}) {
    accelerated.intersect(wave, coherence, hits);
    accelerated.transmittance(wave, coherence, visible);
    for (size_t i = 0; i < wave.size(); ++i) {
      uint32_t closest = kNone;
      ShapeHit nearest{wave.t_max[i], 0};
      for (uint32_t k = 0; k < geometry.shape_instances.size(); ++k) {
        const Affine3d& m = geometry.shape_instances[k].world_from_object;
        std::vector<ShapeHit> found;
        append_hits({line_map(m), &m, &geometry.shapes[k]}, wave.get(i), found);
        if (!found.empty() && found[0].t < nearest.t) closest = k, nearest = found[0];
      }
      ASSERT_EQ(hits.object[i], closest) << "ray " << i;
      if (closest != kNone) {
        ASSERT_EQ(hits.t[i], nearest.t);
        ASSERT_EQ(hits.part[i], nearest.face);
      }
      ASSERT_EQ(visible[i].r, closest == kNone ? 1.0f : 0.0f);
    }
  }
}

TYPED_TEST(Shapes, EachSurfaceDimsAShadowRayOnce) {
  Random random(5);
  Geometry geometry;
  for (uint32_t k = 0; k < 30; ++k) {
    geometry.shapes.push_back(random_shape<TypeParam>(random));
    Affine3d m = random_map(random);
    const double size = std::cbrt(std::abs(determinant(m)));
    geometry.shape_instances.push_back({k, k, 0, {m.x / size, m.y / size, m.z / size, random.in_cube(2)}});
  }
  const Opacity opacity[] = {Opacity::transparent};
  SurfaceFilter filter{opacity};
  filter.transmittance = [](const void*, const Crossing&) noexcept { return Rgb(0.5f, 0.75f, 1.0f); };
  const AcceleratedScene accelerated(geometry, filter);
  RayWave wave;
  wave.resize(2048);
  const Vec3f light{0, 4, 0};
  for (size_t i = 0; i < wave.size(); ++i) {  // side by side, of four octants, towards one point
    const Vec3f origin{float(i % 64) / 16 - 2, -3, float(i / 64) / 8 - 2};
    wave.set(i, {origin, light - origin, 0, 1});
  }
  Lanes<Rgb> visible;
  for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
    accelerated.transmittance(wave, coherence, visible);
    for (size_t i = 0; i < wave.size(); ++i) {
      std::vector<ShapeHit> found;
      for (uint32_t k = 0; k < geometry.shape_instances.size(); ++k) {
        const Affine3d& m = geometry.shape_instances[k].world_from_object;
        append_hits({line_map(m), &m, &geometry.shapes[k]}, wave.get(i), found);
      }
      ASSERT_NEAR(visible[i].r, std::pow(0.5, found.size()), 1e-6) << "ray " << i;
    }
  }
}

}  // namespace
}  // namespace alhazen
