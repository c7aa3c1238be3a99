#include "accel/shapes/triangle.h"

#include <limits>

namespace alhazen {
namespace {

bool in_range(const Rayd& ray, double t) { return t >= ray.t_min && t <= ray.t_max; }

/// Products below the one may have lost digits to underflow; above the other, they may have overflowed.
template <class S>
constexpr double kUnderflow = 0x1p-800;
template <class S>
constexpr double kOverflow = 0x1p900;
template <>
constexpr double kUnderflow<float> = 0x1p-60;
template <>
constexpr double kOverflow<float> = 0x1p60;

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
      : a(widened(t.a) - line.origin), b(widened(t.b) - line.origin), c(widened(t.c) - line.origin) {
    size = larger(largest(a), larger(largest(b), largest(c)));
    error = largest(line.origin_error);
  }
  static Vec3<T> widened(const Vec3d& v) { return Vec3<T>(Vec3<ScalarOf<T>>(v)); }
};

/// direction · (p × edge) for each edge p + s edge, the volume that the line spans with it: all alike inside.
template <class T>
struct EdgeVolumes {
  T ab, bc, ca, bound;  // each is off by less than the bound

  EdgeVolumes(const EdgeVectors<ScalarOf<T>>& edges, const SeenVertices<T>& seen, const ObjectLine<T>& line) {
    using S = ScalarOf<T>;
    const Vec3<T>& d = line.direction;
    ab = dot(d, cross(seen.a, Vec3<T>(edges.ab)));
    bc = dot(d, cross(seen.b, Vec3<T>(edges.bc)));
    ca = dot(d, cross(seen.c, Vec3<T>(edges.ca)));
    // Six products of three factors, each off by its factors' errors and at most 8 roundings.
    const T d_size = largest(d), d_error = largest(line.direction_error);
    const T p_error = seen.error + seen.size * S(10 * kUnitRoundoff<T>);
    bound = (d_size * p_error + d_error * (seen.size + p_error)) * (edges.size * S(6.5)) + S(kUnderflow<S>);
    // Where numbers are too large, nothing is known.
    const T most = T(S(kOverflow<S>));
    bound = select((bound < most) && (seen.size * edges.size < most) && (d_size < most), bound,
                   T(std::numeric_limits<S>::infinity()));
  }

  [[nodiscard]] EdgeSides<T> sides() const {
    const T least = smaller(ab, smaller(bc, ca)), most = larger(ab, larger(bc, ca));
    const auto numbers = ab + bc + ca == ab + bc + ca;  // not NaN
    return {numbers && ((least > bound) || (most < -bound)), numbers && (least < -bound) && (most > bound)};
  }
};

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
TriangleCrossing<T> crossing(const Triangle& triangle, const ObjectLine<T>& line) {
  using S = ScalarOf<T>;
  const double u = kUnitRoundoff<T>;
  TriangleCrossing<T> out;
  const EdgeVectors<S> edges(triangle);
  const SeenVertices<T> seen(triangle, line);
  const EdgeVolumes<T> volumes(edges, seen, line);
  const EdgeSides<T> sides = volumes.sides();
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
      ((seen.error + a_size * (6 * u)) * T(n_size) + (a_size + seen.error) * T(n_error)) * 3.25 + kUnderflow<S>;
  const T speed_error =
      ((d_error + d_size * (6 * u)) * T(n_size) + (d_size + d_error) * T(n_error)) * 3.25 + kUnderflow<S>;
  const auto steep = absolute(speed) > speed_error * 4;
  const T inverse = T(1) / select(steep, speed, T(1)), t = distance * inverse;
  const T t_error = (distance_error + absolute(t) * speed_error) * absolute(inverse) * 1.4 + absolute(t) * (4 * u);
  out.t = t, out.error = t_error, out.present = sides.inside && steep;
  const T share = T(1) / select(sides.inside, volumes.ab + volumes.bc + volumes.ca, T(1));
  out.u = volumes.ca * share, out.v = volumes.ab * share;
  out.doubtful = out.doubtful || (sides.inside && !(steep && (t_error < HUGE_VAL)));
  return out;
}

template TriangleCrossing<DoubleLanes> crossing(const Triangle&, const ObjectLine<DoubleLanes>&);
template TriangleCrossing<double> crossing(const Triangle&, const ObjectLine<double>&);
template TriangleCrossing<Quad> crossing(const Triangle&, const ObjectLine<Quad>&);

template <int N>
uint32_t lanes_that_may_cross(const Triangle& triangle, const Vec3<FloatLanes<N>>& origin,
                              const Vec3<FloatLanes<N>>& direction) {
  using T = FloatLanes<N>;
  const Vec3<T> none{T(0), T(0), T(0)};
  const ObjectLine<T> line{origin, direction, none, none};
  const EdgeVolumes<T> volumes(EdgeVectors<float>(triangle), SeenVertices<T>(triangle, line), line);
  return ~lane_bits(volumes.sides().outside);
}

template uint32_t lanes_that_may_cross<1>(const Triangle&, const Vec3<FloatLanes<1>>&, const Vec3<FloatLanes<1>>&);
template uint32_t lanes_that_may_cross<4>(const Triangle&, const Vec3<FloatLanes<4>>&, const Vec3<FloatLanes<4>>&);
template uint32_t lanes_that_may_cross<8>(const Triangle&, const Vec3<FloatLanes<8>>&, const Vec3<FloatLanes<8>>&);
template uint32_t lanes_that_may_cross<16>(const Triangle&, const Vec3<FloatLanes<16>>&, const Vec3<FloatLanes<16>>&);

std::vector<ExactCrossing> exact_crossings(const Triangle& triangle, const ExactLine& line) {
  const Vec3<Rational> a = exact(triangle.a), b = exact(triangle.b), c = exact(triangle.c);
  const Vec3<Rational> n = cross(b - a, c - a);
  const Rational speed = dot(n, line.direction);
  if (sgn(speed) == 0) return {};
  const int side = exact_side(line, a, b);
  if (exact_side(line, b, c) != side || exact_side(line, c, a) != side) return {};
  return {{Surd(Rational(dot(n, a - line.origin) / speed))}};
}

Vec2d weights_at(const Triangle& triangle, const Vec3d& p) noexcept {
  const auto& [a, b, c] = triangle;
  const Vec3d n = cross(b - a, c - a);
  const double area = dot(n, n);
  return {dot(n, cross(a - c, p - c)) / area, dot(n, cross(b - a, p - a)) / area};
}

}  // namespace alhazen
