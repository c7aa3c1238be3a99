#include "accel/culling_ball.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alhazen {
namespace {

constexpr float kSmallestSquare = 0x1p-60f;  // squares below it may have lost digits to underflow

/// A bound of how much longer the map makes a vector: tight for maps that keep angles.
double largest_stretch(const Affine3d& m) {
  const double xy = std::abs(dot(m.x, m.y)), yz = std::abs(dot(m.y, m.z)), zx = std::abs(dot(m.z, m.x));
  const double rows[] = {dot(m.x, m.x) + xy + zx, dot(m.y, m.y) + yz + xy, dot(m.z, m.z) + zx + yz};
  return std::sqrt(*std::max_element(std::begin(rows), std::end(rows)));
}

float round_up(double x) {
  const float f = float(x);
  return double(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

struct Ball {
  Vec3d center;
  double radius;
};

Ball ball_around(const Bounds3d& box) {
  const Vec3d center = (box.lower + box.upper) * 0.5;
  return {center, length(max(box.upper - center, center - box.lower))};
}

/// In the shape's own space.
Ball enclosing_ball(const Shape& shape, const Bounds3d& bounds) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return {{}, sphere->radius};
  const Ball ball = ball_around(bounds);
  const auto* quadric = std::get_if<Quadric>(&shape);
  return quadric ? Ball{ball.center, std::min(ball.radius, reach_from(*quadric, ball.center))} : ball;
}

/// The test in floats of N lanes.
///
/// With o the line's origin as seen from the centre, the line passes the centre at the distance |o × d| / |d|, and its
/// point at t lies (o·d + t d·d) / |d| behind the centre: what is compared with the radius are squares times d·d, so
/// that nothing is divided.
///
/// accuracy  each of the three lengths is off by at most 16 roundings of |o| |d|. As (R + e)² <= (1 + k) R² + (1 + 1/k)
/// e²
///           for any k, 2^-10 of the squared radius and 2^-29 of |o|² cover that and the roundings of the comparison.
template <int N>
uint32_t may_meet(const CullingBall& ball, const RayRows& rays, const int* valid) {
  using Lanes = FloatLanes<N>;
  const auto load = [](const float* row) { return Lanes(row, std::experimental::element_aligned); };
  const Vec3<Lanes> center{ball.x, ball.y, ball.z}, d = load_directions<N>(rays), o = load_origins<N>(rays) - center;
  const Vec3<Lanes> moment = cross(o, d);
  const Lanes dd = dot(d, d), od = dot(o, d);
  const Lanes reach = (dot(o, o) * 0x1p-29f + ball.squared_radius) * dd;
  const auto beyond = [&](const Lanes& square) { return square > reach && square > kSmallestSquare; };
  const Lanes behind = od + load(rays.t_min()) * dd, ahead = -(od + load(rays.t_max()) * dd);
  const auto misses = (beyond(dot(moment, moment)) || (behind > 0.0f && beyond(behind * behind)) ||
                       (ahead > 0.0f && beyond(ahead * ahead))) &&
                      dd > kSmallestSquare;
  return active_lanes<N>(valid) & ~lane_bits(misses);
}

}  // namespace

CullingBall culling_ball(const PlacedShape& placed, const Bounds3d& object_bounds) {
  const Affine3d& m = *placed.world_from_object;
  const Ball ball = enclosing_ball(*placed.shape, object_bounds);
  const Vec3d center = transform_point(m, ball.center);
  const Vec3f rounded(center);
  const Vec3d reach = abs(m.x) * std::abs(ball.center.x) + abs(m.y) * std::abs(ball.center.y) +
                      abs(m.z) * std::abs(ball.center.z) + abs(m.origin);
  const Vec3d off = abs(center - Vec3d(rounded)) + reach * 0x1p-48;
  const double radius = ball.radius * largest_stretch(m) + length(off);
  return {rounded.x, rounded.y, rounded.z, round_up(std::max(radius * radius * (1 + 0x1p-10), 0x1p-60))};
}

uint32_t lanes_that_may_meet(const CullingBall& ball, const RayRows& rays, const int* valid) noexcept {
  return with_width(rays.width, [&](auto width) { return may_meet<width>(ball, rays, valid); });
}

}  // namespace alhazen
