// What tests of the closed forms share: lines for every number type, the answer by the cheapest type that is sure of
// it, and directions and offsets that are as awkward as they come.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "accel/line.h"
#include "exact/surd.h"

namespace alhazen {

/// A ray of floats as an exact line, which it is.
template <class T>
ObjectLine<T> exact_object_line(const Vec3f& origin, const Vec3f& direction) {
  return {Vec3<T>(Vec3d(origin)), Vec3<T>(Vec3d(direction)), {T(0), T(0), T(0)}, {T(0), T(0), T(0)}};
}
inline ExactLine exact_line(const Vec3f& origin, const Vec3f& direction) {
  return {exact(Vec3d(origin)), exact(Vec3d(direction))};
}

inline Rational exact(Quad x) {
  const auto high = double(x), middle = double(x - Quad(high)), low = double(x - Quad(high) - Quad(middle));
  return exact(high) + exact(middle) + exact(low);
}

/// How often each number type had the last word.
struct DecisionCount {
  int by_double = 0, by_quad = 0, by_rationals = 0, rounded_wrongly = 0;

  [[nodiscard]] int rays() const { return by_double + by_quad + by_rationals; }
};

/// That an answer which is not doubtful is the exact one, and its parameter within its error. True if not doubtful.
template <class T>
bool expect_exact(const LineCrossings<T>& found, const std::vector<ExactCrossing>& exact_answer) {
  if (found.doubtful) return false;
  EXPECT_EQ(found.at[0].present, !exact_answer.empty());
  if (!found.at[0].present || exact_answer.empty()) return true;
  const Rational off = exact(found.at[0].t) - exact_answer[0].t.p;
  EXPECT_LE(abs(off), exact(found.at[0].error));
  EXPECT_EQ(int(double(found.at[0].face)), exact_answer[0].face);
  return true;
}

/// Checks one line on a shape that it crosses at most once: double, binary128 and lanes against rationals.
template <class Shape>
void check_line(const Shape& shape, const Vec3f& origin, const Vec3f& direction, DecisionCount& count) {
  const std::vector<ExactCrossing> answer = exact_crossings(shape, exact_line(origin, direction));
  const LineCrossings<double> single = crossings(shape, exact_object_line<double>(origin, direction));
  const LineCrossings<Quad> wide = crossings(shape, exact_object_line<Quad>(origin, direction));
  const LineCrossings<DoubleLanes> lanes = crossings(shape, exact_object_line<DoubleLanes>(origin, direction));
  ASSERT_LE(answer.size(), 1u);
  const bool single_sure = expect_exact(single, answer), wide_sure = expect_exact(wide, answer);
  for (size_t i = 0; i < DoubleLanes::size(); ++i) {
    EXPECT_EQ(bool(lanes.doubtful[i]), bool(single.doubtful));
    if (!single_sure) continue;
    EXPECT_EQ(bool(lanes.at[0].present[i]), bool(single.at[0].present));
    if (!single.at[0].present) continue;
    EXPECT_EQ(lanes.at[0].t[i], single.at[0].t);
    EXPECT_EQ(lanes.at[0].error[i], single.at[0].error);
  }
  // The answer as a renderer takes it, rounded to float.
  const auto accurate = [](const auto& c) { return c.error <= absolute(c.t) * kParameterAccuracy; };
  const bool by_double = single_sure && (!single.at[0].present || accurate(single.at[0]));
  const bool by_quad = wide_sure && (!wide.at[0].present || accurate(wide.at[0]));
  ++(by_double ? count.by_double : by_quad ? count.by_quad : count.by_rationals);
  if (answer.empty() || !(by_double || by_quad)) return;
  const float t = by_double ? float(single.at[0].t) : float(wide.at[0].t);
  if (t != to_float(answer[0].t)) ++count.rounded_wrongly;
}

using Rng = std::mt19937;

inline double uniform(Rng& rng, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(rng);
}
inline int uniform_int(Rng& rng, int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(rng); }
inline Vec3d uniform_vector(Rng& rng, double lower, double upper) {
  return {uniform(rng, lower, upper), uniform(rng, lower, upper), uniform(rng, lower, upper)};
}
inline Vec3f uniform_lattice(Rng& rng, int size) {
  return {float(uniform_int(rng, -size, size)), float(uniform_int(rng, -size, size)),
          float(uniform_int(rng, -size, size))};
}

/// `x`, 0 or ±2^0..±2^6 units in the last place further.
inline float nudged(Rng& rng, float x) {
  const int k = uniform_int(rng, -7, 7);
  const float towards = std::copysign(std::numeric_limits<float>::infinity(), float(k));
  for (int i = 0; i < (k == 0 ? 0 : 1 << (std::abs(k) - 1)); ++i) x = std::nextafter(x, towards);
  return x;
}
inline Vec3f nudged(Rng& rng, const Vec3f& v) { return {nudged(rng, v.x), nudged(rng, v.y), nudged(rng, v.z)}; }

struct FloatLine {
  Vec3f origin, direction;
};

/// A line through `target` as nearly as floats can say, or a little beside it.
inline FloatLine aimed(Rng& rng, const Vec3d& target, const Vec3d& origin, double length) {
  const Vec3f from(origin);
  return {from, nudged(rng, Vec3f((target - Vec3d(from)) * length))};
}

/// A line of which only so much is known.
struct UncertainLine {
  ObjectLine<double> known;
  ExactLine exactly;  // within the errors
};

/// Both what is known and what is so pass `target` beside it, within what is not known.
inline UncertainLine uncertain_line(Rng& rng, const Vec3d& target, const Vec3d& middle) {
  const Vec3d o = middle + uniform_vector(rng, -3, 3), d = target - o;
  const double accuracy = std::exp2(uniform(rng, -50, -20));
  const Vec3d o_error = abs(o) * accuracy, d_error = abs(d) * accuracy;
  const Vec3d known_o = o + o_error * uniform_vector(rng, -1, 1), known_d = d + d_error * uniform_vector(rng, -1, 1);
  return {{known_o, known_d, o_error, d_error},
          {exact(known_o) + exact(o_error * uniform_vector(rng, -1, 1)),
           exact(known_d) + exact(d_error * uniform_vector(rng, -1, 1))}};
}

/// Lines of every awkward kind for a shape of about the size of [-1, 1]³ about `middle`, with `target` on an edge, a
/// vertex or inside of it.
inline FloatLine awkward_line(Rng& rng, int kind, const Vec3d& target, const Vec3d& middle) {
  const Vec3d near = middle + uniform_vector(rng, -3, 3);
  switch (kind) {
    case 0:
      return {Vec3f(near), Vec3f(uniform_vector(rng, -1, 1))};
    case 1:
      return aimed(rng, target, near, 1);
    case 2:
      return aimed(rng, target, near, std::exp2(uniform_int(rng, -60, 60)));
    case 3:
      return aimed(rng, target, middle + uniform_vector(rng, -1, 1) * 1e6, 1);
    case 4: {  // one or two components are zeros, of either sign
      const int axis = uniform_int(rng, 0, 2), other = uniform_int(rng, 0, 2);
      const auto at = [&](int k) { return k == axis ? uniform(rng, -2, 2) : k == other ? uniform(rng, -1, 1) : -0.0; };
      const Vec3d d{at(0), at(1), at(2)};
      return {nudged(rng, Vec3f(target - d * uniform(rng, -2, 2))), Vec3f(d)};
    }
    case 5:
      return {nudged(rng, Vec3f(target)), Vec3f(uniform_vector(rng, -1, 1))};  // leaves the surface
    default: {                                                                 // a lattice: what is met is met exactly
      const Vec3f origin = Vec3f(middle) + uniform_lattice(rng, 4);
      return {origin, Vec3f(target) - origin};
    }
  }
}
inline constexpr int kAwkwardKinds = 7;

}  // namespace alhazen
