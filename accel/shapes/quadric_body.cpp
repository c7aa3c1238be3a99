#include "accel/shapes/quadric_body.h"

#include <optional>

namespace alhazen {
namespace {

using Crossing = std::optional<ExactCrossing>;  // none: unbounded on that side

/// The closed interval of the line within the box.
struct Interval {
  Crossing enter, leave;
  bool empty = false;
};

bool earlier(const ExactCrossing& a, const ExactCrossing& b) { return compare(a.t, b.t) < 0; }

void narrow(Interval& interval, const Rational& o, const Rational& d, const Rational& lower, const Rational& upper,
            int axis) {
  if (sgn(d) == 0) {
    interval.empty = interval.empty || o < lower || o > upper;
    return;
  }
  const bool backward = sgn(d) < 0;
  const ExactCrossing at_lower{Surd(Rational((lower - o) / d)), 2 * axis};
  const ExactCrossing at_upper{Surd(Rational((upper - o) / d)), 2 * axis + 1};
  const ExactCrossing &near = backward ? at_upper : at_lower, &far = backward ? at_lower : at_upper;
  if (!interval.enter || earlier(*interval.enter, near)) interval.enter = near;
  if (!interval.leave || earlier(far, *interval.leave)) interval.leave = far;
}

struct Quadratic {
  Rational a, b, c;  // a t² + 2 b t + c
};

Quadratic along(const QuadricBody<Rational>& q, const ExactLine& line) {
  const auto &p = line.origin, &d = line.direction;
  const auto form = [&](const Vec3<Rational>& v) -> Vec3<Rational> {
    return {Rational(q.a * v.x + q.d * v.y + q.e * v.z), Rational(q.d * v.x + q.b * v.y + q.f * v.z),
            Rational(q.e * v.x + q.f * v.y + q.c * v.z)};
  };
  const auto product = [](const Vec3<Rational>& v, const Vec3<Rational>& w) {
    return Rational(v.x * w.x + v.y * w.y + v.z * w.z);
  };
  const Vec3<Rational> form_d = form(d), linear{q.g, q.h, q.i};
  return {product(d, form_d), Rational(product(p, form_d) + product(linear, d)),
          Rational(product(p, form(p)) + 2 * product(linear, p) + q.j)};
}

/// Where f falls through 0 and where it rises; f of constant sign has neither. A double root is both.
struct Roots {
  std::optional<Surd> enter, leave;
  bool touching = false;  // a double root
};

Roots roots_of(const Quadratic& q) {
  Roots roots;
  if (sgn(q.a) == 0) {
    if (sgn(q.b) == 0) return roots;
    (sgn(q.b) < 0 ? roots.enter : roots.leave) = Surd(Rational(-q.c / (2 * q.b)));
    return roots;
  }
  const Rational discriminant = q.b * q.b - q.a * q.c;
  if (sgn(discriminant) < 0) return roots;
  const Rational middle = -q.b / q.a, width = 1 / q.a;
  roots.enter = Surd(middle, Rational(-width), discriminant);
  roots.leave = Surd(middle, width, discriminant);
  roots.touching = sgn(discriminant) == 0;
  return roots;
}

bool within(const Surd& t, const Interval& interval) {
  return (!interval.enter || compare(t, interval.enter->t) >= 0) &&
         (!interval.leave || compare(t, interval.leave->t) <= 0);
}

/// Adds [enter, leave] cut to `interval`, if a point of it is left.
void add_cut(const Crossing& enter, const Crossing& leave, const Interval& interval, std::vector<ExactCrossing>& out) {
  Crossing first = interval.enter, last = interval.leave;
  if (enter && (!first || earlier(*first, *enter))) first = enter;
  if (leave && (!last || earlier(*leave, *last))) last = leave;
  if (!first || !last || compare(first->t, last->t) > 0) return;
  out.push_back(*first);
  out.push_back(*last);
}

std::vector<ExactCrossing> open_crossings(const Roots& roots, const Interval& interval) {
  std::vector<ExactCrossing> out;
  for (const auto* root : {&roots.enter, &roots.leave})
    if (*root && within(**root, interval)) out.push_back({**root});
  if (out.size() == 2 && roots.touching) out.pop_back();
  if (out.size() == 2 && earlier(out[1], out[0])) std::swap(out[0], out[1]);
  return out;
}

}  // namespace

std::vector<ExactCrossing> exact_crossings(const QuadricBody<Rational>& body, BodyParts parts, const ExactLine& line) {
  std::vector<ExactCrossing> out;
  const auto &p = line.origin, &d = line.direction;
  if (sgn(d.x) == 0 && sgn(d.y) == 0 && sgn(d.z) == 0) return out;
  Interval interval;
  if (parts.planes) {
    narrow(interval, p.x, d.x, body.lower.x, body.upper.x, 0);
    narrow(interval, p.y, d.y, body.lower.y, body.upper.y, 1);
    narrow(interval, p.z, d.z, body.lower.z, body.upper.z, 2);
    if (interval.empty || compare(interval.enter->t, interval.leave->t) > 0) return out;
  }
  if (!parts.wall) {
    add_cut({}, {}, interval, out);
    return out;
  }
  const Quadratic q = along(body, line);
  const Roots roots = roots_of(q);
  if (!body.solid) return open_crossings(roots, interval);
  const auto wall = [](const std::optional<Surd>& t) { return t ? Crossing(ExactCrossing{*t}) : Crossing(); };
  if (!roots.enter && !roots.leave) {
    if (sgn(q.c) <= 0) add_cut({}, {}, interval, out);
  } else if (!roots.enter || !roots.leave || compare(*roots.enter, *roots.leave) < 0 ||
             (roots.touching && sgn(q.a) > 0)) {
    add_cut(wall(roots.enter), wall(roots.leave), interval, out);
  } else if (roots.touching) {
    add_cut({}, {}, interval, out);  // f <= 0 on the whole line
  } else {
    add_cut({}, wall(roots.leave), interval, out);
    add_cut(wall(roots.enter), {}, interval, out);
  }
  return out;
}

}  // namespace alhazen
