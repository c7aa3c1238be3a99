// A general quadric from its ten coefficients: open in a box, or solid with flat caps where the box cuts it.
#pragma once

#include <array>
#include <optional>

#include "accel/shapes/flat_face.h"
#include "accel/shapes/quadric_body.h"
#include "core/lane_vec.h"
#include "core/ray.h"

namespace alhazen {

/// f(p) = A x² + B y² + C z² + 2D xy + 2E xz + 2F yz + 2G x + 2H y + 2I z + J, inside where f < 0.
struct Quadric {
  std::array<double, 10> coefficients{1, 1, 1, 0, 0, 0, 0, 0, 0, -1};  // A ... J
  Bounds3d box{{-1, -1, -1}, {1, 1, 1}};  // finite; a whole ellipsoid lies within it and is not cut
  bool solid = false;                     // { f <= 0 } within the box is a closed body
  bool whole = false;                     // an ellipsoid that the box does not cut: said so, it costs less
};

/// f at a point; N is double or lanes of doubles, each with its quadric.
template <class N>
[[nodiscard]] N quadric_value(const std::array<N, 10>& q, const Vec3<N>& p) {
  return p.x * (q[0] * p.x + N(2) * (q[3] * p.y + q[4] * p.z + q[6])) +
         p.y * (q[1] * p.y + N(2) * (q[5] * p.z + q[7])) + p.z * (q[2] * p.z + N(2) * q[8]) + q[9];
}

/// Half of ∇f.
template <class N>
[[nodiscard]] Vec3<N> quadric_half_gradient(const std::array<N, 10>& q, const Vec3<N>& p) {
  return {q[0] * p.x + q[3] * p.y + q[4] * p.z + q[6], q[3] * p.x + q[1] * p.y + q[5] * p.z + q[7],
          q[4] * p.x + q[5] * p.y + q[2] * p.z + q[8]};
}

/// A point near { f = 0 } put onto it by two of Newton's steps along the gradient.
template <class N>
[[nodiscard]] Vec3<N> project_to_wall(const std::array<N, 10>& q, Vec3<N> p) {
  const auto finite = [](const N& x) { return x - x == N(0); };
  MaskOf<N> goes_on(true);
  for (int step = 0; step < 2; ++step) {
    const Vec3<N> g = quadric_half_gradient(q, p);
    const N squared = dot(g, g);
    const Vec3<N> moved = p - g * N(quadric_value(q, p) / (N(2) * squared));
    goes_on = goes_on && squared > N(0) && finite(moved.x) && finite(moved.y) && finite(moved.z);
    p = {select(goes_on, moved.x, p.x), select(goes_on, moved.y, p.y), select(goes_on, moved.z, p.z)};
  }
  return p;
}

/// Whether f may be the square of a plane, up to a factor: its gradient then vanishes on the whole surface.
template <class N>
[[nodiscard]] MaskOf<N> may_be_square(const std::array<N, 10>& q) {
  return q[0] * q[1] == q[3] * q[3] && q[0] * q[2] == q[4] * q[4] && q[1] * q[2] == q[5] * q[5];
}

/// `v` over its length, also where its square underflows; 0 stays 0.
template <class N>
[[nodiscard]] Vec3<N> scaled_to_unit(const Vec3<N>& v) {
  const N size = larger(absolute(v.x), larger(absolute(v.y), absolute(v.z)));
  const MaskOf<N> any = size > N(0);
  const Vec3<N> unit = normalize(v / select(any, size, N(1)));
  return {select(any, unit.x, v.x), select(any, unit.y, v.y), select(any, unit.z, v.z)};
}

/// ∇f / |∇f| at a point of { f = 0 }, towards f > 0. On a double plane, that plane's; zero at other singular points.
template <class N>
[[nodiscard]] Vec3<N> wall_normal(const std::array<N, 10>& q, const Vec3<N>& p) {
  const auto size = [](const Vec3<N>& v) { return larger(absolute(v.x), larger(absolute(v.y), absolute(v.z))); };
  const Vec3<N> g = quadric_half_gradient(q, p), unit = scaled_to_unit(g);
  const MaskOf<N> square = may_be_square(q);
  if (!any_of(square)) return unit;
  // Where f is the square of a plane, the row of A ... F with the largest entry is that plane's normal.
  Vec3<N> plane{q[0], q[3], q[4]};
  for (const Vec3<N>& row : {Vec3<N>{q[3], q[1], q[5]}, Vec3<N>{q[4], q[5], q[2]}})
    plane = select(size(row) > size(plane), row, plane);
  return select(square && size(g) <= size(plane) * N(0x1p-20) * (N(1) + size(p)), scaled_to_unit(plane), unit);
}

/// The box of an ellipsoid's surface, a little enlarged (its centre alone where nothing of it is real); none where
/// A ... F is not definite.
[[nodiscard]] std::optional<Bounds3d> ellipsoid_bounds(const std::array<double, 10>& coefficients);

template <class N>
[[nodiscard]] QuadricBody<N> quadric_body(const Quadric& quadric) {
  const auto& q = quadric.coefficients;
  QuadricBody<N> body{N(q[0]), N(q[1]), N(q[2]), N(q[3]), N(q[4]), N(q[5]),      N(q[6]),
                      N(q[7]), N(q[8]), N(q[9]), {},      {},      quadric.solid};
  body.lower = Vec3<N>(quadric.box.lower), body.upper = Vec3<N>(quadric.box.upper);
  return body;
}

/// Solid, where a line enters and leaves the body; open, where it meets the surface within the closed box.
template <class T>
[[nodiscard]] LineCrossings<T> crossings(const Quadric& quadric, const ObjectLine<T>& line) {
  const auto body = quadric_body<CoefficientOf<T>>(quadric);
  return quadric.whole ? body_crossings<BodyForm::whole>(body, line) : body_crossings<BodyForm::general>(body, line);
}
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const Quadric& quadric, const ExactLine& line);

/// Tight up to 1 % of the box where the surface leaves parts of it empty; empty where nothing can be hit.
[[nodiscard]] Bounds3d bounds(const Quadric& quadric) noexcept;

/// No point of the shape is further from `p_object`, by the form's eigenvalues alone: infinite where they do not bound
/// it.
[[nodiscard]] double reach_from(const Quadric& quadric, const Vec3d& p_object) noexcept;

[[nodiscard]] std::optional<FlatFace<double>> flat_face(const Quadric& quadric, int face) noexcept;
[[nodiscard]] Vec3d project(const Quadric& quadric, const Vec3d& p_object, int face) noexcept;

/// ∇f / |∇f|, towards f > 0; on a cap, the box face's. On a double plane, that plane's; zero at other singular points.
[[nodiscard]] Vec3d normal(const Quadric& quadric, const Vec3d& p_object, int face) noexcept;

/// u = (x - min.x) / (max.x - min.x), v = (z - min.z) / (max.z - min.z), of the box.
[[nodiscard]] Vec2f texture_coordinates(const Quadric& quadric, const Vec3d& p_object, int face) noexcept;
[[nodiscard]] Vec3d u_tangent(const Quadric& quadric, const Vec3d& p_object, int face) noexcept;

}  // namespace alhazen
