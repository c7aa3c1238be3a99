// { f <= 0 } within a box, f a quadratic polynomial: what spheres, cylinders, cones, boxes and general quadrics are to
// a line. As a closed body it is entered and left; open, only the wall f = 0 inside the box is there.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "accel/line.h"

namespace alhazen {

/// How much of the general case a kind of shape needs. Lanes pay only for what is there.
enum class BodyForm {
  revolution,  // x² + z² + b y² + 2 h y + j between two planes y = const
  box,         // no wall
  whole,       // all ten coefficients, no plane
  general,     // all ten coefficients and all six planes
};

/// f(p) = a x² + b y² + c z² + 2 d x y + 2 e x z + 2 f y z + 2 g x + 2 h y + 2 i z + j, for lower <= p <= upper. N is
/// double, binary128 or Rational: the rounded coefficients of the first two are off by a few roundings.
template <class N>
struct QuadricBody {
  N a{}, b{}, c{}, d{}, e{}, f{}, g{}, h{}, i{}, j{};
  Vec3<N> lower, upper;
  bool solid = true;
};

/// What the line {origin + s direction} meets of the axis-aligned box: the parameters between, with errors and faces.
template <class T>
struct SlabInterval {
  T enter{-std::numeric_limits<double>::infinity()}, leave{std::numeric_limits<double>::infinity()};
  T enter_error{0}, leave_error{0}, enter_face{0}, leave_face{0};
  MaskOf<T> empty{false}, doubtful{false};
};

/// f along the line, a s² + 2 b s + c, each coefficient with its error.
template <class T>
struct ErrorQuadratic {
  T a, b, c, a_error, b_error, c_error;
};

/// The roots of a quadratic: `enter` where f falls through 0, `leave` where it rises. Between them f < 0 if enter <
/// leave, else f < 0 outside of them.
template <class T>
struct QuadraticRoots {
  T enter, leave, enter_error, leave_error;
  MaskOf<T> exist, doubtful;
};

namespace quadric_detail {

inline constexpr double kFar = 0x1p900;  // further than any parameter that counts

template <class T>
T largest(const Vec3<T>& v) {
  return larger(absolute(v.x), larger(absolute(v.y), absolute(v.z)));
}

/// One axis' pair of planes. `steep`: the line crosses them at parameters worth computing.
template <class T>
struct Slab {
  T o, d, o_error, d_error;
  double lower, upper;
  int axis;

  [[nodiscard]] T plane_error() const {
    return o_error + (absolute(o) + larger(std::abs(lower), std::abs(upper))) * (4 * kUnitRoundoff<T>);
  }
  [[nodiscard]] MaskOf<T> steep() const { return absolute(d) > d_error * 4; }
};

/// Narrows `interval` by the slab where it is steep.
template <class T>
void narrow(const Slab<T>& slab, SlabInterval<T>& interval, T& enter_second, T& leave_second) {
  const double u = kUnitRoundoff<T>;
  const T inf(std::numeric_limits<double>::infinity());
  const auto steep = slab.steep();
  const T inverse = T(1) / select(steep, slab.d, T(1));
  const auto backward = inverse < T(0);
  const T at_lower = (T(slab.lower) - slab.o) * inverse, at_upper = (T(slab.upper) - slab.o) * inverse;
  const T near = select(steep, select(backward, at_upper, at_lower), -inf);
  const T far = select(steep, select(backward, at_lower, at_upper), inf);
  const T size = absolute(inverse), fixed = slab.plane_error() * size * 2;
  const T relative = slab.d_error * size * 2 + T(8 * u);
  const T near_error = select(steep, fixed + absolute(near) * relative, T(0));
  const T far_error = select(steep, fixed + absolute(far) * relative, T(0));
  const T lower_face(2.0 * slab.axis), upper_face(2.0 * slab.axis + 1);
  const auto later = near > interval.enter, earlier = far < interval.leave;
  enter_second = larger(enter_second, select(later, interval.enter, near));
  leave_second = smaller(leave_second, select(earlier, interval.leave, far));
  interval.enter = select(later, near, interval.enter);
  interval.leave = select(earlier, far, interval.leave);
  interval.enter_face = select(later, select(backward, upper_face, lower_face), interval.enter_face);
  interval.leave_face = select(earlier, select(backward, lower_face, upper_face), interval.leave_face);
  interval.enter_error = larger(interval.enter_error, near_error);
  interval.leave_error = larger(interval.leave_error, far_error);
}

/// The furthest parameter that counts.
template <class T>
T reach_of(const SlabInterval<T>& interval) {
  return larger(absolute(interval.enter) + interval.enter_error, absolute(interval.leave) + interval.leave_error);
}

/// A line that runs along the slab is inside or outside of it as far as `reach`.
template <class T>
void decide_parallel(const Slab<T>& slab, const T& reach, SlabInterval<T>& interval) {
  const auto parallel = !slab.steep();
  const T drift = absolute(slab.d) + slab.d_error;
  const T margin = slab.plane_error() + select(drift > T(0), drift * reach, T(0));
  const T above = slab.o - T(slab.lower), below = T(slab.upper) - slab.o;
  const auto inside = (above > margin) && (below > margin), outside = (above < -margin) || (below < -margin);
  interval.empty = interval.empty || (parallel && outside);
  interval.doubtful = interval.doubtful || (parallel && !inside && !outside);
}

template <class T, BodyForm kForm, class N>
SlabInterval<T> slab_interval(const QuadricBody<N>& body, const ObjectLine<T>& line) {
  SlabInterval<T> interval;
  const Slab<T> x{line.origin.x,
                  line.direction.x,
                  line.origin_error.x,
                  line.direction_error.x,
                  double(body.lower.x),
                  double(body.upper.x),
                  0};
  const Slab<T> y{line.origin.y,
                  line.direction.y,
                  line.origin_error.y,
                  line.direction_error.y,
                  double(body.lower.y),
                  double(body.upper.y),
                  1};
  const Slab<T> z{line.origin.z,
                  line.direction.z,
                  line.origin_error.z,
                  line.direction_error.z,
                  double(body.lower.z),
                  double(body.upper.z),
                  2};
  constexpr bool kOnlyY = kForm == BodyForm::revolution;
  T enter_second(-std::numeric_limits<double>::infinity()), leave_second(std::numeric_limits<double>::infinity());
  if constexpr (!kOnlyY) narrow(x, interval, enter_second, leave_second);
  narrow(y, interval, enter_second, leave_second);
  if constexpr (!kOnlyY) narrow(z, interval, enter_second, leave_second);
  const T reach = reach_of(interval);
  if constexpr (!kOnlyY) decide_parallel(x, reach, interval);
  decide_parallel(y, reach, interval);
  if constexpr (!kOnlyY) decide_parallel(z, reach, interval);
  const T gap = interval.leave - interval.enter, gap_error = interval.enter_error + interval.leave_error;
  interval.empty = interval.empty || (gap < -gap_error);
  interval.doubtful = interval.doubtful || (!interval.empty && !(gap > gap_error));
  // Two planes met at once: the line runs through an edge, and the face is in doubt.
  if constexpr (!kOnlyY)
    interval.doubtful = interval.doubtful || !(interval.enter - enter_second > interval.enter_error * 2) ||
                        !(leave_second - interval.leave > interval.leave_error * 2);
  interval.doubtful = interval.doubtful && !interval.empty;
  return interval;
}

template <class T, BodyForm kForm, class N>
ErrorQuadratic<T> quadratic_along(const QuadricBody<N>& q, const ObjectLine<T>& line) {
  const double u = kUnitRoundoff<T>;
  const Vec3<T>&p = line.origin, &d = line.direction;
  const T p_size = largest(p), d_size = largest(d), p_error = largest(line.origin_error),
          d_error = largest(line.direction_error);
  ErrorQuadratic<T> r;
  double form_size, linear_size, j_size = std::abs(double(q.j));
  if constexpr (kForm == BodyForm::revolution) {
    const T b(q.b), h(q.h);
    r.a = d.x * d.x + d.z * d.z + b * (d.y * d.y);
    r.b = p.x * d.x + p.z * d.z + (b * p.y + h) * d.y;
    r.c = p.x * p.x + p.z * p.z + (b * p.y + h * T(2)) * p.y + T(q.j);
    form_size = 2 + std::abs(double(q.b)), linear_size = std::abs(double(q.h));
  } else {
    const auto form = [&](const Vec3<T>& v) {
      return Vec3<T>{T(q.a) * v.x + T(q.d) * v.y + T(q.e) * v.z, T(q.d) * v.x + T(q.b) * v.y + T(q.f) * v.z,
                     T(q.e) * v.x + T(q.f) * v.y + T(q.c) * v.z};
    };
    const Vec3<T> linear{T(q.g), T(q.h), T(q.i)}, form_p = form(p);
    r.a = dot(d, form(d)), r.b = dot(d, form_p + linear), r.c = dot(p, form_p + linear * T(2)) + T(q.j);
    form_size = std::abs(double(q.a)) + std::abs(double(q.b)) + std::abs(double(q.c)) +
                2 * (std::abs(double(q.d)) + std::abs(double(q.e)) + std::abs(double(q.f)));
    linear_size = std::abs(double(q.g)) + std::abs(double(q.h)) + std::abs(double(q.i));
  }
  // |x'Qy| <= form_size |x| |y| in the largest norm. A coefficient is off by at most 5 roundings; sums and products
  // round 6 times in a, 7 times in b, 8 times in c. Each vector bears 6 of them.
  const T gradient_size = p_size * form_size + T(linear_size), pe = p_error + p_size * (6 * u),
          de = d_error + d_size * (6 * u);
  r.a_error = de * d_size * (2.5 * form_size);
  r.b_error = gradient_size * de + d_size * (pe * form_size) * 1.25 + T(linear_size * 10 * u) * d_size;
  r.c_error = (gradient_size + T(linear_size)) * pe * 2.5 + T(j_size * 8 * u) + p_error * p_error * form_size;
  return r;
}

template <class T>
QuadraticRoots<T> roots(const ErrorQuadratic<T>& q, const T& reach) {
  const double u = kUnitRoundoff<T>;
  QuadraticRoots<T> r;
  const T ac = q.a * q.c, bb = q.b * q.b, discriminant = bb - ac, b_size = absolute(q.b), a_size = absolute(q.a);
  const T error =
      (b_size * q.b_error * 2 + a_size * q.c_error + absolute(q.c) * q.a_error + (bb + absolute(ac)) * (3 * u)) * 1.25 +
      q.b_error * q.b_error + q.a_error * q.c_error;
  // Far from 0 everywhere within reach: the wall does not matter, however ill it is conditioned.
  const auto constant = absolute(q.c) - q.c_error > ((b_size + q.b_error) * 2 + (a_size + q.a_error) * reach) * reach;
  const auto none = constant || (discriminant < -error);
  r.exist = !none && (discriminant > error * 2);
  const T root = square_root(select(r.exist, discriminant, T(1)));
  const auto falling = q.b < T(0);  // f falls at the line's origin
  const T sum = b_size + root, sum_error = q.b_error + error / root + sum * (2 * u);
  const T signed_sum = select(falling, sum, -sum);
  // The one root is signed_sum / a, the other c / signed_sum. Nearly flat, the first is out of reach on its side.
  const auto flat = sum - sum_error > (a_size + q.a_error) * reach * 2;
  const T a = select(flat, T(1), q.a);
  const T far_root = select(flat, select(falling, T(kFar), T(-kFar)), signed_sum / a);
  const T far_error =
      select(flat, T(0), (sum_error + absolute(far_root) * q.a_error) / absolute(a) * 2 + absolute(far_root) * (4 * u));
  const T near_root = q.c / signed_sum;
  const T near_error = (q.c_error + absolute(near_root) * sum_error) / sum * 2 + absolute(near_root) * (4 * u);
  r.enter = select(falling, near_root, far_root), r.enter_error = select(falling, near_error, far_error);
  r.leave = select(falling, far_root, near_root), r.leave_error = select(falling, far_error, near_error);
  r.doubtful = !none && (!r.exist || (!flat && !(a_size > q.a_error * 2)) || !(sum > sum_error * 2));
  return r;
}

/// Puts crossings of the local line into a list that counts from the original line's origin, `t0` before it.
template <class T>
struct CrossingWriter {
  LineCrossings<T>& out;
  T t0;

  void operator()(size_t k, const T& s, const T& error, const T& face, const MaskOf<T>& present) const {
    out.at[k] = {t0 + s, error + (absolute(t0) + absolute(s)) * (2 * kUnitRoundoff<T>), face, present};
  }
};

/// Whether a root and a plane lie too close together to be told apart.
template <class T>
MaskOf<T> meets_rim(const QuadraticRoots<T>& root, const SlabInterval<T>& slab) {
  const auto tied = [](const T& a, const T& a_error, const T& b, const T& b_error) {
    return !(absolute(a - b) > a_error + b_error);
  };
  return tied(root.enter, root.enter_error, slab.enter, slab.enter_error) ||
         tied(root.enter, root.enter_error, slab.leave, slab.leave_error) ||
         tied(root.leave, root.leave_error, slab.enter, slab.enter_error) ||
         tied(root.leave, root.leave_error, slab.leave, slab.leave_error);
}

/// The wall alone: those roots that lie within the box.
template <class T>
void write_open(const QuadraticRoots<T>& root, const SlabInterval<T>& slab, const CrossingWriter<T>& write) {
  const auto between = root.enter < root.leave, exist = root.exist && !slab.empty;
  const auto within = [&](const T& s) { return exist && s > slab.enter && s < slab.leave; };
  const auto enter_there = within(root.enter), leave_there = within(root.leave);
  const T wall(kWallFace);
  write(0, select(between, root.enter, root.leave), select(between, root.enter_error, root.leave_error), wall,
        (between && enter_there) || (!between && leave_there));
  write(1, select(between, root.leave, root.enter), select(between, root.leave_error, root.enter_error), wall,
        (between && leave_there) || (!between && enter_there));
}

/// The wall alone, of a body without planes.
template <class T>
void write_whole(const QuadraticRoots<T>& root, const CrossingWriter<T>& write) {
  const auto between = root.enter < root.leave;
  const T wall(kWallFace);
  write(0, select(between, root.enter, root.leave), select(between, root.enter_error, root.leave_error), wall,
        root.exist);
  write(1, select(between, root.leave, root.enter), select(between, root.leave_error, root.enter_error), wall,
        root.exist);
}

/// The closed body: between the roots one interval, outside of them two; without roots all of the box or nothing.
template <class T>
void write_solid(const QuadraticRoots<T>& root, const SlabInterval<T>& slab, const MaskOf<T>& inside_without_roots,
                 const CrossingWriter<T>& write) {
  const auto between = root.enter < root.leave;
  const auto there = !slab.empty && (root.exist || inside_without_roots);
  const auto late = root.enter > slab.enter, from_root = root.exist && between && late;
  const auto to_root = root.exist && root.leave < slab.leave;
  const T wall(kWallFace);
  const T first = select(from_root, root.enter, slab.enter), last = select(to_root, root.leave, slab.leave);
  const auto first_there = there && first < last;
  write(0, first, select(from_root, root.enter_error, slab.enter_error), select(from_root, wall, slab.enter_face),
        first_there);
  write(1, last, select(to_root, root.leave_error, slab.leave_error), select(to_root, wall, slab.leave_face),
        first_there);
  const T again = select(late, root.enter, slab.enter);
  const auto again_there = there && root.exist && !between && again < slab.leave;
  write(2, again, select(late, root.enter_error, slab.enter_error), select(late, wall, slab.enter_face), again_there);
  write(3, slab.leave, slab.leave_error, slab.leave_face, again_there);
}

}  // namespace quadric_detail

/// Where a line meets the body's surface. Closed bodies: entered and left in turns, with the face of each; open ones:
/// the points of the wall in the closed box. Planes rounded to double are taken as exact.
///
/// accuracy  each parameter's error bound holds; `doubtful` where the bounds leave open what is met, or in which order.
/// source    forward error analysis after Higham, Accuracy and Stability of Numerical Algorithms (2002), ch. 3; roots
///           from the point nearest to the body: Haines, Günther, Akenine-Möller, Ray Tracing Gems (2019), ch. 7.
template <BodyForm kForm, class T, class N>
[[nodiscard]] LineCrossings<T> body_crossings(const QuadricBody<N>& body, const ObjectLine<T>& line) {
  using namespace quadric_detail;
  LineCrossings<T> out;
  // Count parameters from the point nearest to the body's centre: there, nothing large cancels.
  const Vec3<T> center{T((body.lower.x + body.upper.x) * 0.5), T((body.lower.y + body.upper.y) * 0.5),
                       T((body.lower.z + body.upper.z) * 0.5)};
  const T t0 = dot(center - line.origin, line.direction) / dot(line.direction, line.direction);
  const ObjectLine<T> local = moved_origin(line, t0);
  const CrossingWriter<T> write{out, t0};
  if constexpr (kForm == BodyForm::whole) {
    const QuadraticRoots<T> root = roots(quadratic_along<T, kForm>(body, local), T(HUGE_VAL));
    out.doubtful = root.doubtful;
    write_whole(root, write);
    return out;
  }
  const SlabInterval<T> slab = slab_interval<T, kForm>(body, local);
  out.doubtful = slab.doubtful;
  if constexpr (kForm == BodyForm::box) {
    write(0, slab.enter, slab.enter_error, slab.enter_face, !slab.empty);
    write(1, slab.leave, slab.leave_error, slab.leave_face, !slab.empty);
  } else {
    const ErrorQuadratic<T> quadratic = quadratic_along<T, kForm>(body, local);
    const QuadraticRoots<T> root = roots(quadratic, reach_of(slab));
    out.doubtful = out.doubtful || (!slab.empty && (root.doubtful || (root.exist && meets_rim(root, slab))));
    if (body.solid)
      write_solid(root, slab, !root.exist && quadratic.c < T(0), write);
    else
      write_open(root, slab, write);
  }
  return out;
}

/// What of a body is there: its six planes, its curved wall.
struct BodyParts {
  bool planes = true, wall = true;
};

/// The same, exactly, ascending. A double root is entered and left at once; a line within the wall crosses none of it;
/// a zero direction crosses nothing. Through an edge, the smallest face counts.
[[nodiscard]] std::vector<ExactCrossing> exact_crossings(const QuadricBody<Rational>& body, BodyParts parts,
                                                         const ExactLine& line);

/// The number type in which a body's coefficients serve lines of type T.
template <class T>
using CoefficientOf = std::conditional_t<std::is_same_v<T, Quad>, Quad, double>;

}  // namespace alhazen
