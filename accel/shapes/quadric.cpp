#include "accel/shapes/quadric.h"

#include <cmath>

namespace alhazen {
namespace {

struct Interval {
  double lower, upper;
};
Interval operator+(Interval a, Interval b) { return {a.lower + b.lower, a.upper + b.upper}; }
Interval operator*(Interval a, Interval b) {
  const double p = a.lower * b.lower, q = a.lower * b.upper, r = a.upper * b.lower, s = a.upper * b.upper;
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
Interval operator*(double a, Interval b) { return Interval{a, a} * b; }
Interval squared(Interval a) {
  const double l = a.lower * a.lower, u = a.upper * a.upper;
  return {a.lower <= 0 && a.upper >= 0 ? 0 : std::min(l, u), std::max(l, u)};
}

/// Whether a part of the box may hold some of the surface (of the body, if solid).
bool may_hold(const Quadric& quadric, const Bounds3d& part) {
  const auto& q = quadric.coefficients;
  const Interval x{part.lower.x, part.upper.x}, y{part.lower.y, part.upper.y}, z{part.lower.z, part.upper.z};
  const Interval f = q[0] * squared(x) + q[1] * squared(y) + q[2] * squared(z) + 2 * q[3] * (x * y) +
                     2 * q[4] * (x * z) + 2 * q[5] * (y * z) + 2 * q[6] * x + 2 * q[7] * y + 2 * q[8] * z +
                     Interval{q[9], q[9]};
  double scale = std::abs(q[9]);
  const double size = std::max(max_component(abs(part.lower)), max_component(abs(part.upper)));
  for (int k = 0; k < 9; ++k) scale += 2 * std::abs(q[size_t(k)]) * size * (k < 6 ? size : 1);
  const double rounding = scale * 0x1p-46;
  if (!(f.lower <= f.upper)) return true;  // overflow
  return f.lower <= rounding && (quadric.solid || f.upper >= -rounding);
}

double& component(Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

constexpr int kCells = 8;  // across the box, for the search

/// Cuts off of one side of `box` what surely holds nothing, one of `slices` slices at a time.
void trim(const Quadric& quadric, Bounds3d& box, int axis, bool from_below, int slices) {
  const double width = (box.upper[axis] - box.lower[axis]) / slices;
  for (int s = 0; s + 1 < slices; ++s) {
    Bounds3d slice = box;
    const double edge = from_below ? box.lower[axis] + width : box.upper[axis] - width;
    component(from_below ? slice.upper : slice.lower, axis) = edge;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < kCells * kCells; ++i) {
      Bounds3d cell = slice;
      const auto cut = [&](int along, int k) {
        const double step = (slice.upper[along] - slice.lower[along]) / kCells;
        component(cell.lower, along) = slice.lower[along] + step * k;
        if (k + 1 < kCells) component(cell.upper, along) = slice.lower[along] + step * (k + 1);
      };
      cut(u, i % kCells), cut(v, i / kCells);
      if (may_hold(quadric, cell)) return;
    }
    component(from_below ? box.lower : box.upper, axis) = edge;
  }
}

}  // namespace

std::optional<Bounds3d> ellipsoid_bounds(const std::array<double, 10>& c) {
  // Work with the sign that makes the form positive.
  const double sign = c[0] > 0 ? 1 : -1;
  std::array<Rational, 10> q;
  for (size_t k = 0; k < 10; ++k) q[k] = exact(sign * c[k]);
  // The adjugate of the form and its leading minors, exactly.
  const Rational a11 = q[1] * q[2] - q[5] * q[5], a22 = q[0] * q[2] - q[4] * q[4], a33 = q[0] * q[1] - q[3] * q[3];
  const Rational a12 = q[4] * q[5] - q[3] * q[2], a13 = q[3] * q[5] - q[4] * q[1], a23 = q[3] * q[4] - q[0] * q[5];
  const Rational det = q[0] * a11 + q[3] * a12 + q[4] * a13;
  if (sgn(q[0]) <= 0 || sgn(a33) <= 0 || sgn(det) <= 0) return {};
  // Centre m = -Q^-1 g; f(m) = j + g·m; the half extents are sqrt(-f(m) (Q^-1)_ii).
  const Rational mx = -(a11 * q[6] + a12 * q[7] + a13 * q[8]) / det;
  const Rational my = -(a12 * q[6] + a22 * q[7] + a23 * q[8]) / det;
  const Rational mz = -(a13 * q[6] + a23 * q[7] + a33 * q[8]) / det;
  const Rational depth = -(q[9] + q[6] * mx + q[7] * my + q[8] * mz);
  const auto half = [&](const Rational& minor) {
    return sgn(depth) > 0 ? double(to_quad(Surd(0, 1, Rational(depth * minor / det)))) * 1.01 : 0.0;
  };
  const Vec3d center{mx.get_d(), my.get_d(), mz.get_d()}, extent{half(a11), half(a22), half(a33)};
  const Bounds3d box{center - extent, center + extent};
  return is_finite(box.lower) && is_finite(box.upper) ? std::optional(box) : std::nullopt;
}

std::vector<ExactCrossing> exact_crossings(const Quadric& quadric, const ExactLine& line) {
  return exact_crossings(quadric_body<Rational>(quadric), BodyParts{}, line);
}

Bounds3d bounds(const Quadric& quadric) noexcept {
  Bounds3d box = quadric.box;
  // Coarsely, then finely in what is left.
  for (const int slices : {16, 16})
    for (int axis = 0; axis < 3; ++axis)
      trim(quadric, box, axis, true, slices), trim(quadric, box, axis, false, slices);
  return box;
}

double reach_from(const Quadric& quadric, const Vec3d& p_object) noexcept {
  const auto& q = quadric.coefficients;
  const double side = q[0] < 0 && !quadric.solid ? -1 : 1;  // the wall is that of -f, too
  const double xy = std::abs(q[3]), xz = std::abs(q[4]), yz = std::abs(q[5]), rounding = 0x1p-46;
  const double form = std::abs(q[0]) + std::abs(q[1]) + std::abs(q[2]) + 2 * (xy + xz + yz);
  const double linear = std::abs(q[6]) + std::abs(q[7]) + std::abs(q[8]), size = max_component(abs(p_object));
  // No eigenvalue is less than this (Gershgorin's circles).
  const double least =
      std::min(side * q[0] - xy - xz, std::min(side * q[1] - xy - yz, side * q[2] - xz - yz)) - form * rounding;
  if (!(least > 0)) return HUGE_VAL;
  // f(p + s) = s'Qs + 2 g·s + f(p) <= 0 only for least |s|² - 2 |g| |s| + f(p) <= 0.
  const double g = length(quadric_half_gradient(q, p_object)) + (form * size + linear) * rounding;
  const double f = side * quadric_value(q, p_object) - ((form * size + 2 * linear) * size + std::abs(q[9])) * rounding;
  return (g + std::sqrt(std::max(g * g - least * f, 0.0))) / least * (1 + rounding);
}

std::optional<FlatFace<double>> flat_face(const Quadric& quadric, int face) noexcept {
  if (face == kWallFace) return {};
  return flat_face(face, (face & 1 ? quadric.box.upper : quadric.box.lower)[face / 2]);
}

Vec3d project(const Quadric& quadric, const Vec3d& p_object, int face) noexcept {
  const auto cap = flat_face(quadric, face);
  return cap ? project(*cap, p_object) : project_to_wall(quadric.coefficients, p_object);
}

Vec3d normal(const Quadric& quadric, const Vec3d& p_object, int face) noexcept {
  const auto cap = flat_face(quadric, face);
  return cap ? normal(*cap) : wall_normal(quadric.coefficients, p_object);
}

Vec2f texture_coordinates(const Quadric& quadric, const Vec3d& p, int) noexcept {
  const Vec3d &lower = quadric.box.lower, &upper = quadric.box.upper;
  return {float((p.x - lower.x) / (upper.x - lower.x)), float((p.z - lower.z) / (upper.z - lower.z))};
}

Vec3d u_tangent(const Quadric& quadric, const Vec3d& p_object, int face) noexcept {
  // The x axis, laid into the surface.
  const Vec3d n = normal(quadric, p_object, face), x{1, 0, 0};
  return x - n * n.x;
}

}  // namespace alhazen
