#include "crosscheck/exact_ties.h"

#include "accel/shapes/polygon_plane.h"

namespace alhazen::crosscheck {
namespace {

using ExactVec = Vec3<Rational>;

ExactVec point_at(const ExactLine& line, const Rational& t) {
  return {Rational(line.origin.x + t * line.direction.x), Rational(line.origin.y + t * line.direction.y),
          Rational(line.origin.z + t * line.direction.z)};
}

Rational inner(const ExactVec& a, const ExactVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ExactVec form(const QuadricBody<Rational>& q, const ExactVec& v) {
  return {Rational(q.a * v.x + q.d * v.y + q.e * v.z), Rational(q.d * v.x + q.b * v.y + q.f * v.z),
          Rational(q.e * v.x + q.f * v.y + q.c * v.z)};
}

/// Where a line stands to a body's box and wall.
class BodyTie {
 public:
  BodyTie(const QuadricBody<Rational>& body, BodyParts parts, const ExactLine& line) {
    if (parts.planes)
      for (int axis = 0; axis < 3; ++axis)
        add_slab(line.origin[axis], line.direction[axis], body.lower[axis], body.upper[axis]);
    if (parts.wall) add_wall(body, line);
  }

  [[nodiscard]] Tie tie() const {
    if (outside_) return Tie::none;
    for (size_t i = 0; i < params_.size(); ++i)
      for (size_t k = 0; k < i; ++k)
        if (compare(params_[i], params_[k]) == 0 && within_box(params_[i])) return Tie::edge;
    if (coplanar_) return Tie::coplanar;
    return touching_ && within_box(*touching_) ? Tie::tangent : Tie::none;
  }

 private:
  void add_slab(const Rational& o, const Rational& d, const Rational& lower, const Rational& upper) {
    if (sgn(d) == 0) {
      coplanar_ = coplanar_ || o == lower || o == upper;
      outside_ = outside_ || o < lower || o > upper;
      return;
    }
    Surd a{Rational((lower - o) / d)}, b{Rational((upper - o) / d)};
    if (sgn(d) < 0) std::swap(a, b);
    params_.push_back(a), params_.push_back(b);
    slabs_.push_back({std::move(a), std::move(b)});
  }

  void add_wall(const QuadricBody<Rational>& q, const ExactLine& line) {
    const ExactVec linear{q.g, q.h, q.i}, form_o = form(q, line.origin);
    const Rational a = inner(line.direction, form(q, line.direction));
    const Rational b = inner(line.direction, form_o) + inner(line.direction, linear);
    const Rational c = inner(line.origin, form_o) + 2 * inner(line.origin, linear) + q.j;
    if (sgn(a) == 0) {
      if (sgn(b) != 0) params_.emplace_back(Rational(-c / (2 * b)));
      coplanar_ = coplanar_ || (sgn(b) == 0 && sgn(c) == 0);
      return;
    }
    const Rational discriminant = b * b - a * c, middle = -b / a, width = 1 / a;
    if (sgn(discriminant) == 0) touching_ = Surd(middle);
    if (sgn(discriminant) > 0) {
      params_.emplace_back(middle, width, discriminant);
      params_.emplace_back(middle, Rational(-width), discriminant);
    }
  }

  [[nodiscard]] bool within_box(const Surd& t) const {
    for (const auto& [enter, leave] : slabs_)
      if (compare(t, enter) < 0 || compare(t, leave) > 0) return false;
    return true;
  }

  std::vector<Surd> params_;
  std::vector<std::pair<Surd, Surd>> slabs_;
  std::optional<Surd> touching_;
  bool coplanar_ = false, outside_ = false;
};

Tie tie_of(const Sphere& s, const ExactLine& line) {
  return BodyTie(quadric_body<Rational>(s), {.planes = false, .wall = true}, line).tie();
}
Tie tie_of(const Cylinder& s, const ExactLine& line) { return BodyTie(quadric_body<Rational>(s), {}, line).tie(); }
Tie tie_of(const Quadric& s, const ExactLine& line) { return BodyTie(quadric_body<Rational>(s), {}, line).tie(); }
Tie tie_of(const Box& s, const ExactLine& line) {
  return BodyTie(quadric_body<Rational>(s), {.planes = true, .wall = false}, line).tie();
}

Tie tie_of(const Disk& disk, const ExactLine& line) {
  if (sgn(line.direction.y) == 0) return sgn(line.origin.y) == 0 ? Tie::coplanar : Tie::none;
  const ExactVec p = point_at(line, Rational(-line.origin.y / line.direction.y));
  const Rational squared = p.x * p.x + p.z * p.z, outer = exact(disk.radius), inner_radius = exact(disk.inner_radius);
  const bool on_rim = squared == outer * outer || (disk.inner_radius > 0 && squared == inner_radius * inner_radius);
  return on_rim ? Tie::edge : Tie::none;
}

/// Whether (x, y) lies on the closed segment from a to b.
bool on_segment(const Rational& x, const Rational& y, const ExactVec& a, const ExactVec& b) {
  const Rational side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
  const Rational before = (x - a.x) * (x - b.x) + (y - a.y) * (y - b.y);
  return sgn(side) == 0 && sgn(before) <= 0;
}

Tie tie_of(const Polygon& polygon, const ExactLine& line) {
  const auto& plane = polygon.exact_plane;
  const ExactVec o = to_plane_axes(line.origin - exact(polygon.center), polygon.dropped_axis);
  const ExactVec d = to_plane_axes(line.direction, polygon.dropped_axis);
  const Rational speed = d.z - plane.slope_x * d.x - plane.slope_y * d.y;
  const Rational height = o.z - plane.offset - plane.slope_x * o.x - plane.slope_y * o.y;
  if (sgn(speed) == 0) return sgn(height) == 0 ? Tie::coplanar : Tie::none;
  const Rational t = -height / speed, x = o.x + t * d.x, y = o.y + t * d.y;
  const auto vertex = [&](uint32_t k) {
    return to_plane_axes(exact(polygon.vertices[k]) - exact(polygon.center), polygon.dropped_axis);
  };
  for (const Polygon::Edge& edge : polygon.edges)
    if (on_segment(x, y, vertex(edge.first), vertex(edge.second))) return Tie::edge;
  return Tie::none;
}

Tie tie_of(const Triangle& triangle, const ExactLine& line) {
  const ExactVec a = exact(triangle.a), b = exact(triangle.b), c = exact(triangle.c);
  const ExactVec n = cross(b - a, c - a);
  if (sgn(dot(n, line.direction)) == 0) return sgn(dot(n, a - line.origin)) == 0 ? Tie::coplanar : Tie::none;
  int least = 1, most = -1;
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const int side = sgn(dot(cross(line.direction, p - line.origin), q - p));
    least = std::min(least, side), most = std::max(most, side);
  }
  const bool touches = least >= 0 || most <= 0, strictly = least > 0 || most < 0;
  return touches && !strictly ? Tie::edge : Tie::none;
}

Tie tie_of(const Composite& composite, const ExactLine& line) {
  std::vector<Surd> met;
  for (const CompositeLeaf& leaf : composite.leaves) {
    const ExactLine leaf_line = exact_line(leaf.chain, line);
    const Tie own = std::visit([&](const auto& body) { return tie_of(body, leaf_line); }, leaf.body);
    if (own != Tie::none) return own;
    for (ExactCrossing& c : std::visit([&](const auto& body) { return exact_crossings(body, leaf_line); }, leaf.body)) {
      for (const Surd& other : met)
        if (compare(c.t, other) == 0) return Tie::edge;
      met.push_back(std::move(c.t));
    }
  }
  return Tie::none;
}

}  // namespace

const char* name_of(Tie tie) {
  constexpr const char* names[] = {"none", "edge", "tangent", "coplanar"};
  return names[size_t(tie)];
}

Tie tie_of(const Surface& surface, const ExactLine& line) {
  return std::visit([&](const auto& s) { return tie_of(s, line); }, surface);
}

}  // namespace alhazen::crosscheck
