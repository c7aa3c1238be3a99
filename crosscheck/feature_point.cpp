#include "crosscheck/feature_point.h"

#include <numbers>

namespace alhazen::crosscheck {
namespace {

/// On a circle about the y axis; often at the seam or a quarter of the way around.
Vec3d on_circle(double radius, double y, Random& random) {
  const double turns = random.coin() ? random.uniform(0, 1) : random.integer(0, 3) * 0.25;
  const double angle = 2 * std::numbers::pi * turns;
  return {radius * std::sin(angle), y, radius * std::cos(angle)};
}

Vec3d feature(const Sphere& s, Random& random) {
  const double y = random.coin() ? 0.0 : random.uniform();  // the equator, the poles, the seam
  return on_circle(s.radius * std::sqrt(1 - y * y), s.radius * y, random);
}

Vec3d feature(const Cylinder& c, Random& random) {
  const bool top = random.coin();
  return on_circle(top ? c.radius_top : c.radius_bottom, (top ? 0.5 : -0.5) * c.height, random);
}

Vec3d feature(const Disk& disk, Random& random) {
  return on_circle(random.coin() ? disk.radius : disk.inner_radius, 0, random);
}

Vec3d feature(const Box& box, Random& random) {
  const auto side = [&] { return random.coin() ? 0.5 : -0.5; };
  const double x = side(), y = side(), z = random.coin() ? side() : random.uniform(-0.5, 0.5);
  const int axis = random.integer(0, 2);
  const Vec3d p = axis == 0 ? Vec3d{x, y, z} : axis == 1 ? Vec3d{y, z, x} : Vec3d{z, x, y};
  return p * box.size;
}

Vec3d along_edge(const Vec3d& a, const Vec3d& b, Random& random) {
  return random.coin() ? a : a + (b - a) * random.uniform(0, 1);
}

Vec3d feature(const Polygon& polygon, Random& random) {
  const auto& edge = polygon.edges[random.bits() % polygon.edges.size()];
  return along_edge(polygon.vertices[edge.first], polygon.vertices[edge.second], random);
}

Vec3d feature(const Triangle& t, Random& random) {
  const Vec3d corners[] = {t.a, t.b, t.c};
  const int k = random.integer(0, 2);
  return along_edge(corners[k], corners[(k + 1) % 3], random);
}

/// Where the wall meets a face of the box: a root of f along a line within the face.
Vec3d feature(const Quadric& quadric, Random& random) {
  const QuadricBody<double> q = quadric_body<double>(quadric);
  const auto f = [&](const Vec3d& p) {
    return p.x * (q.a * p.x + 2 * (q.d * p.y + q.e * p.z + q.g)) + p.y * (q.b * p.y + 2 * (q.f * p.z + q.h)) +
           p.z * (q.c * p.z + 2 * q.i) + q.j;
  };
  const Vec3d &lower = quadric.box.lower, &upper = quadric.box.upper;
  const int axis = random.integer(0, 2);
  const bool top = random.coin();
  const auto in_face = [&] {
    const auto at = [&](int k) {
      return k == axis ? (top ? upper : lower)[k] : lower[k] + (upper[k] - lower[k]) * random.uniform(0, 1);
    };
    const double x = at(0), y = at(1);
    return Vec3d{x, y, at(2)};
  };
  Vec3d a = in_face(), b = in_face();
  for (int tries = 0; tries < 8 && (f(a) < 0) == (f(b) < 0); ++tries) b = in_face();
  for (int k = 0; k < 60; ++k) {  // bisection
    const Vec3d middle = (a + b) * 0.5;
    ((f(middle) < 0) == (f(a) < 0) ? a : b) = middle;
  }
  return a;
}

Vec3d feature(const Composite& composite, Random& random) {
  const CompositeLeaf& leaf = composite.leaves[random.bits() % composite.leaves.size()];
  Vec3d p = std::visit([&](const auto& body) { return feature(body, random); }, leaf.body);
  for (size_t k = leaf.chain.size(); k-- > 0;) p = transform_point(leaf.chain[k], p);
  return p;
}

}  // namespace

Vec3d feature_point(const Surface& surface, Random& random) {
  return std::visit([&](const auto& s) { return feature(s, random); }, surface);
}

}  // namespace alhazen::crosscheck
