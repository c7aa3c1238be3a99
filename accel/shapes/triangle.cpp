#include "accel/shapes/triangle.h"

#include <type_traits>

namespace alhazen {
namespace {

bool in_range(const Rayd& ray, double t) { return t >= ray.t_min && t <= ray.t_max; }

/// What one lane of T is made of.
template <class T>
using ScalarOf = std::conditional_t<std::is_same_v<T, DoubleLanes>, double, T>;

/// Products below the one may have lost digits to underflow; above the other, they may have overflowed.
constexpr double kUnderflow = 0x1p-800, kOverflow = 0x1p900;

template <class T>
T largest(const Vec3<T>& v) {
  return larger(absolute(v.x), larger(absolute(v.y), absolute(v.z)));
}

/// Where the line stands to the triangle's three edges.
template <class T>
struct EdgeSides {
  MaskOf<T> inside, outside;  // neither: in doubt
};

/// The edges of a triangle, each from the vertex of the same place.
template <class S>
struct EdgeVectors {
  Vec3<S> ab, bc, ca;
  S size;  // of the largest component

  explicit EdgeVectors(const Triangle& t)
      : ab(Vec3<S>(t.b) - Vec3<S>(t.a)), bc(Vec3<S>(t.c) - Vec3<S>(t.b)), ca(Vec3<S>(t.a) - Vec3<S>(t.c)) {
    size = larger(largest(ab), larger(largest(bc), largest(ca)));
  }
};

/// The triangle's vertices as seen from the line's origin.
template <class T>
struct SeenVertices {
  Vec3<T> a, b, c;
  T size, error;  // of the largest component

  SeenVertices(const Triangle& t, const ObjectLine<T>& line)
      : a(Vec3<T>(t.a) - line.origin), b(Vec3<T>(t.b) - line.origin), c(Vec3<T>(t.c) - line.origin) {
    size = larger(largest(a), larger(largest(b), largest(c)));
    error = largest(line.origin_error);
  }
};

/// The signs of direction · (p × edge), the volume that the line spans with each edge p + s edge: all alike inside.
template <class T>
EdgeSides<T> edge_sides(const EdgeVectors<ScalarOf<T>>& edges, const SeenVertices<T>& seen, const ObjectLine<T>& line) {
  const Vec3<T>& d = line.direction;
  const T ab = dot(d, cross(seen.a, Vec3<T>(edges.ab))), bc = dot(d, cross(seen.b, Vec3<T>(edges.bc))),
          ca = dot(d, cross(seen.c, Vec3<T>(edges.ca)));
  // Six products of three factors, each off by its factors' errors and at most 8 roundings.
  const T d_size = largest(d), d_error = largest(line.direction_error);
  const T p_error = seen.error + seen.size * (10 * kUnitRoundoff<T>);
  const T bound = (d_size * p_error + d_error * (seen.size + p_error)) * (T(edges.size) * 6.5) + kUnderflow;
  const T least = smaller(ab, smaller(bc, ca)), most = larger(ab, larger(bc, ca));
  // The comparisons are written so that NaN is in doubt.
  const auto is_number = (least <= most) && (bound < kOverflow) && (seen.size * T(edges.size) < kOverflow);
  return {is_number && ((least > bound) || (most < -bound)), is_number && (least < -bound) && (most > bound)};
}

/// The side on which the line passes the edge from p to q, seen along the line, ties broken by moving the line. Zero
/// only for edges parallel to the line.
int exact_side(const ExactLine& line, const Vec3<Rational>& p, const Vec3<Rational>& q) {
  // direction · ((p - origin) × edge) = (direction × (p - origin)) · edge; its gradient by the origin is
  // direction × edge.
  const Vec3<Rational> edge = q - p, moment = cross(line.direction, p - line.origin);
  const int side = sgn(dot(moment, edge));
  if (side != 0) return side;
  const Vec3<Rational> gradient = cross(line.direction, edge);
  if (sgn(gradient.x) != 0) return sgn(gradient.x);
  return sgn(gradient.y) != 0 ? sgn(gradient.y) : sgn(gradient.z);
}

}  // namespace

std::optional<TriangleHit> intersect_by_half_spaces(const Triangle& triangle, const Rayd& ray) noexcept {
  const auto& [a, b, c] = triangle;
  const Vec3d n = cross(b - a, c - a);
  const double t = dot(n, a - ray.origin) / dot(n, ray.direction);
  if (!in_range(ray, t)) return std::nullopt;
  const Vec3d p = point_at(ray, t);
  const double area = dot(n, n), area_a = dot(n, cross(c - b, p - b)), area_b = dot(n, cross(a - c, p - c)),
               area_c = dot(n, cross(b - a, p - a));
  if (!(area_a >= 0 && area_b >= 0 && area_c >= 0)) return std::nullopt;
  return TriangleHit{t, area_b / area, area_c / area};
}

std::optional<TriangleHit> intersect_by_cramer(const Triangle& triangle, const Rayd& ray) noexcept {
  const Vec3d ab = triangle.b - triangle.a, ac = triangle.c - triangle.a, from_a = ray.origin - triangle.a;
  const Vec3d p = cross(ray.direction, ac), q = cross(from_a, ab);
  const double determinant = dot(ab, p);
  const double u = dot(from_a, p) / determinant, v = dot(ray.direction, q) / determinant, t = dot(ac, q) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && in_range(ray, t))) return std::nullopt;
  return TriangleHit{t, u, v};
}

template <class T>
LineCrossings<T> crossings(const Triangle& triangle, const ObjectLine<T>& line) {
  using S = ScalarOf<T>;
  const double u = kUnitRoundoff<T>;
  LineCrossings<T> out;
  const EdgeVectors<S> edges(triangle);
  const SeenVertices<T> seen(triangle, line);
  const EdgeSides<T> sides = edge_sides<T>(edges, seen, line);
  out.doubtful = !sides.inside && !sides.outside;
  if (!any_of(sides.inside)) return out;

  // t = n · a / n · direction with n = ab × bc.
  const Vec3<S> n = cross(edges.ab, edges.bc);
  const S n_size = largest(n), n_error = edges.size * edges.size * S(10 * u);
  const Vec3<T> n_lanes(n);
  const T d_size = largest(line.direction), d_error = largest(line.direction_error);
  const T a_size = largest(seen.a);
  const T distance = dot(n_lanes, seen.a), speed = dot(n_lanes, line.direction);
  const T distance_error =
      ((seen.error + a_size * (6 * u)) * T(n_size) + (a_size + seen.error) * T(n_error)) * 3.25 + kUnderflow;
  const T speed_error =
      ((d_error + d_size * (6 * u)) * T(n_size) + (d_size + d_error) * T(n_error)) * 3.25 + kUnderflow;
  const auto steep = absolute(speed) > speed_error * 4;
  const T inverse = T(1) / select(steep, speed, T(1)), t = distance * inverse;
  const T t_error = (distance_error + absolute(t) * speed_error) * absolute(inverse) * 1.4 + absolute(t) * (4 * u);
  out.at[0] = {t, t_error, T(kWallFace), sides.inside && steep};
  out.doubtful = out.doubtful || (sides.inside && !(steep && (t_error < HUGE_VAL)));
  return out;
}

template LineCrossings<DoubleLanes> crossings(const Triangle&, const ObjectLine<DoubleLanes>&);
template LineCrossings<double> crossings(const Triangle&, const ObjectLine<double>&);
template LineCrossings<Quad> crossings(const Triangle&, const ObjectLine<Quad>&);

std::vector<ExactCrossing> exact_crossings(const Triangle& triangle, const ExactLine& line) {
  const Vec3<Rational> a = exact(triangle.a), b = exact(triangle.b), c = exact(triangle.c);
  const Vec3<Rational> n = cross(b - a, c - a);
  const Rational speed = dot(n, line.direction);
  if (sgn(speed) == 0) return {};
  const int side = exact_side(line, a, b);
  if (exact_side(line, b, c) != side || exact_side(line, c, a) != side) return {};
  return {{Surd(Rational(dot(n, a - line.origin) / speed))}};
}

}  // namespace alhazen
