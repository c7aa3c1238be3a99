#include <gtest/gtest.h>

#include <numeric>

#include "accel/culling_ball.h"
#include "decide.h"

namespace alhazen {
namespace {

/// Sixteen rays in rows, as packets of any width.
struct Packet {
  std::vector<Rayf> rays;

  [[nodiscard]] uint32_t lanes_that_may_meet(const CullingBall& ball, unsigned width) const {
    uint32_t lanes = 0;
    for (unsigned first = 0; first < rays.size(); first += width) {
      std::vector<float> rows(12 * width);
      for (unsigned i = 0; i < width; ++i) {
        const Rayf& r = rays[first + i];
        const float values[] = {r.origin.x,    r.origin.y,    r.origin.z, r.t_min, r.direction.x,
                                r.direction.y, r.direction.z, 0,          r.t_max};
        for (unsigned row = 0; row < 9; ++row) rows[row * width + i] = values[row];
      }
      const std::vector<int> valid(width, -1);
      lanes |= alhazen::lanes_that_may_meet(ball, {rows.data(), width}, valid.data()) << first;
    }
    return lanes;
  }
};

Shape random_shape(Rng& rng) {
  switch (uniform_int(rng, 0, 3)) {
    case 0:
      return Sphere{uniform(rng, 0.5, 1)};
    case 1:
      return Cylinder{1, 0.3, 0.2, true};
    case 2:
      return Box{{0.3, 0.6, 0.9}};
    default: {
      Quadric q;
      for (size_t k = 0; k < 9; ++k) q.coefficients[k] = k < 3 ? uniform(rng, 0.5, 2) : uniform(rng, -0.2, 0.2);
      q.coefficients[9] = -uniform(rng, 0.2, 0.5), q.solid = uniform_int(rng, 0, 1) != 0;
      if (uniform_int(rng, 0, 1)) q.box = *ellipsoid_bounds(q.coefficients), q.whole = true;
      return q;
    }
  }
}

Affine3d random_place(Rng& rng) {
  const double scale = std::exp2(uniform(rng, -20, 20));
  if (uniform_int(rng, 0, 1))
    return {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}, uniform_vector(rng, -1, 1) * (100 * scale)};
  const auto axis = [&] { return uniform_vector(rng, -1, 1) * scale; };
  return {axis(), axis(), axis(), axis() * 10.0};
}

/// To a point about the shape, mostly near its outline; its range often ends at a hit or close to it.
Rayf random_ray(Rng& rng, const PlacedShape& placed, double size) {
  const Affine3d& m = *placed.world_from_object;
  const Vec3d target = transform_point(m, normalize(uniform_vector(rng, -1, 1)) * uniform(rng, 0.2, 1.2));
  const Vec3d origin = m.origin + uniform_vector(rng, -1, 1) * (size * std::exp2(uniform(rng, -1, 10)));
  const FloatLine line = aimed(rng, target, origin, std::exp2(uniform_int(rng, -30, 30)));
  Rayf ray{line.origin, line.direction};
  std::vector<ShapeHit> hits;
  append_hits(placed, ray, hits);
  if (hits.empty() || uniform_int(rng, 0, 1)) return ray;
  const float t = nudged(rng, hits[size_t(uniform_int(rng, 0, int(hits.size()) - 1))].t);
  (uniform_int(rng, 0, 1) ? ray.t_min : ray.t_max) = t;
  return ray;
}

TEST(CullingBall, NeverLeavesOutARayThatHits) {
  Rng rng(71);
  int hit = 0, left_out = 0;
  for (int i = 0; i < 3000; ++i) {
    const Shape shape = random_shape(rng);
    const Affine3d place = random_place(rng);
    const PlacedShape placed{line_map(place), &place, &shape};
    const Bounds3d bounds = std::visit([](const auto& s) { return alhazen::bounds(s); }, shape);
    const CullingBall ball = culling_ball(placed, bounds);
    const double size = std::cbrt(std::abs(determinant(place)));
    Packet packet;
    for (int k = 0; k < 16; ++k) packet.rays.push_back(random_ray(rng, placed, size));
    for (const unsigned width : {1, 4, 8, 16}) {
      const uint32_t lanes = packet.lanes_that_may_meet(ball, width);
      for (size_t k = 0; k < 16; ++k) {
        std::vector<ShapeHit> hits;
        append_hits(placed, packet.rays[k], hits);
        hit += !hits.empty(), left_out += !(lanes >> k & 1);
        ASSERT_TRUE(hits.empty() || (lanes >> k & 1)) << "shape " << i << ", ray " << k << ", width " << width;
      }
    }
  }
  EXPECT_GT(hit, 50000);
  EXPECT_GT(left_out, 20000);
}

TEST(CullingBall, LeavesOutRaysThatPassARoundShapeOrLieBesideIt) {
  Quadric round;
  round.coefficients = {4, 4, 4, 0, 0, 0, 0, 0, 0, -1}, round.box = {{-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}};
  const Affine3d place{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {5, -3, 1}};  // radius 1
  for (const Shape& shape : {Shape(Sphere{0.5}), Shape(round)}) {
    const Bounds3d bounds = std::visit([](const auto& s) { return alhazen::bounds(s); }, shape);
    const CullingBall ball = culling_ball({line_map(place), &place, &shape}, bounds);
    const Packet packet{{{{5, -3 + 0.97f, 9}, {0, 0, -2}},
                         {{5, -3 + 1.03f, 9}, {0, 0, -2}},
                         {{5, -3, 9}, {0, 0, 2}},
                         {{5, -3, 9}, {0, 0, -2}, 0, 3.4f}}};
    EXPECT_EQ(packet.lanes_that_may_meet(ball, 4), 1u);
  }
}

}  // namespace
}  // namespace alhazen
