#include "crosscheck/ball_crossings.h"

#include <algorithm>

#include "accel/shapes/polygon_plane.h"

namespace alhazen::crosscheck {
namespace {

using BallVec = Vec3<Ball>;
using Crossings = std::vector<BallCrossing>;

/// Insertion by certain comparisons; two at one place are in doubt.
void sort_certainly(Crossings& list) {
  for (size_t i = 1; i < list.size(); ++i)
    for (size_t k = i; k > 0; --k) {
      const int order = sign(list[k].t - list[k - 1].t);
      if (order == 0) throw InDoubt();
      if (order > 0) break;
      std::swap(list[k], list[k - 1]);
    }
}

/// A body cut by a line: polynomials in the line's parameter.
class BodyLine {
 public:
  BodyLine(const QuadricBody<Ball>& body, BodyParts parts, const BallLine& line)
      : body_(body), parts_(parts), line_(line) {
    const auto form = [&](const BallVec& v) {
      return BallVec{body.a * v.x + body.d * v.y + body.e * v.z, body.d * v.x + body.b * v.y + body.f * v.z,
                     body.e * v.x + body.f * v.y + body.c * v.z};
    };
    const BallVec linear{body.g, body.h, body.i}, form_o = form(line.origin);
    a_ = dot(line.direction, form(line.direction));
    b_ = dot(line.direction, form_o + linear);
    c_ = dot(line.origin, form_o) + Ball(2.0) * dot(line.origin, linear) + body.j;
  }

  /// Every parameter at which the line may change from inside to outside.
  [[nodiscard]] Crossings candidates() const {
    Crossings list;
    if (parts_.wall) add_wall(list);
    if (parts_.planes)
      for (int axis = 0; axis < 3; ++axis) add_planes(axis, list);
    sort_certainly(list);
    return list;
  }

  [[nodiscard]] bool inside_wall(const Ball& t) const {
    return !parts_.wall || sign((a_ * t + Ball(2.0) * b_) * t + c_) < 0;
  }
  [[nodiscard]] bool inside_box(const Ball& t) const {
    if (!parts_.planes) return true;
    for (int axis = 0; axis < 3; ++axis) {
      const Ball p = line_.origin[axis] + t * line_.direction[axis];
      const int above = sign(p - body_.lower[axis]), below = sign(body_.upper[axis] - p);
      if (above == 0 || below == 0) throw InDoubt();  // along a plane
      if (above < 0 || below < 0) return false;
    }
    return true;
  }

 private:
  void add_wall(Crossings& list) const {
    if (sign(a_) == 0) {
      if (sign(b_) != 0) list.push_back({-c_ / (Ball(2.0) * b_), kWallFace});
      return;
    }
    const Ball discriminant = b_ * b_ - a_ * c_;
    const int s = sign(discriminant);
    if (s == 0) throw InDoubt();  // tangent
    if (s < 0) return;
    const Ball root = square_root(discriminant);
    list.push_back({(-b_ - root) / a_, kWallFace});
    list.push_back({(-b_ + root) / a_, kWallFace});
  }
  void add_planes(int axis, Crossings& list) const {
    if (sign(line_.direction[axis]) == 0) return;
    list.push_back({(body_.lower[axis] - line_.origin[axis]) / line_.direction[axis], 2 * axis});
    list.push_back({(body_.upper[axis] - line_.origin[axis]) / line_.direction[axis], 2 * axis + 1});
  }

  const QuadricBody<Ball>& body_;
  BodyParts parts_;
  const BallLine& line_;
  Ball a_, b_, c_;
};

/// Solid: where membership changes. Open: where the wall is met inside the box.
Crossings body_crossings(const QuadricBody<Ball>& body, BodyParts parts, const BallLine& line) {
  const BodyLine cut(body, parts, line);
  const Crossings all = cut.candidates();
  Crossings out;
  if (!body.solid) {
    for (const BallCrossing& c : all)
      if (c.face == kWallFace && cut.inside_box(c.t)) out.push_back(c);
    return out;
  }
  bool inside = false;
  for (size_t k = 0; k < all.size(); ++k) {
    const bool last = k + 1 == all.size();
    const Ball middle = last ? Ball() : (all[k].t + all[k + 1].t) * Ball(0.5);
    const bool now = !last && cut.inside_box(middle) && cut.inside_wall(middle);
    if (now != inside) out.push_back(all[k]);
    inside = now;
  }
  return out;
}

Crossings surface_crossings(const Sphere& s, const BallLine& line) {
  return body_crossings(quadric_body<Ball>(s), {.planes = false, .wall = true}, line);
}
Crossings surface_crossings(const Cylinder& s, const BallLine& line) {
  return body_crossings(quadric_body<Ball>(s), {}, line);
}
Crossings surface_crossings(const Quadric& s, const BallLine& line) {
  return body_crossings(quadric_body<Ball>(s), {}, line);
}
Crossings surface_crossings(const Box& s, const BallLine& line) {
  return body_crossings(quadric_body<Ball>(s), {.planes = true, .wall = false}, line);
}

Crossings surface_crossings(const Disk& disk, const BallLine& line) {
  if (sign(line.direction.y) == 0) return sign(line.origin.y) == 0 ? throw InDoubt() : Crossings{};
  const Ball t = -line.origin.y / line.direction.y;
  const Ball x = line.origin.x + t * line.direction.x, z = line.origin.z + t * line.direction.z;
  const Ball squared = x * x + z * z, outer = Ball(disk.radius) * Ball(disk.radius);
  const Ball inner = Ball(disk.inner_radius) * Ball(disk.inner_radius);
  const int below_outer = sign(outer - squared), above_inner = inner.is_zero() ? 1 : sign(squared - inner);
  if (below_outer == 0 || above_inner == 0) throw InDoubt();
  return below_outer > 0 && above_inner > 0 ? Crossings{{t, 3}} : Crossings{};
}

Crossings surface_crossings(const Triangle& triangle, const BallLine& line) {
  const auto seen = [&](const Vec3d& p) { return BallVec(p) - line.origin; };
  const BallVec a = seen(triangle.a), b = seen(triangle.b), c = seen(triangle.c);
  const auto side = [&](const BallVec& p, const BallVec& q) {
    const int s = sign(dot(line.direction, cross(p, q)));
    if (s == 0) throw InDoubt();
    return s;
  };
  const int ab = side(a, b), bc = side(b, c), ca = side(c, a);
  if (ab != bc || bc != ca) return {};
  const BallVec n = cross(b - a, c - a);
  const Ball speed = dot(n, line.direction);
  if (sign(speed) == 0) throw InDoubt();
  return {{dot(n, a) / speed, kWallFace}};
}

/// Even-odd, by the edges that cross the horizontal line through the point to its right.
bool inside_polygon(const Polygon& polygon, const std::set<std::pair<uint32_t, uint32_t>>& edges, const Ball& x,
                    const Ball& y) {
  const auto vertex = [&](uint32_t k) {
    return to_plane_axes(BallVec(polygon.vertices[k]) - BallVec(polygon.center), polygon.dropped_axis);
  };
  bool inside = false;
  for (const auto& [first, second] : edges) {
    const BallVec a = vertex(first), b = vertex(second);
    const int above_a = sign(y - a.y), above_b = sign(y - b.y);
    if (above_a == 0 || above_b == 0) throw InDoubt();
    if (above_a == above_b) continue;
    const int side = sign((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x));
    if (side == 0) throw InDoubt();
    if ((side > 0) == (above_a > 0)) inside = !inside;
  }
  return inside;
}

bool is_inside(const Composite& composite, const std::vector<bool>& inside_leaf, uint32_t at = 0) {
  const CompositeNode& node = composite.nodes[at];
  if (node.operation == CompositeNode::Operation::leaf) return inside_leaf[node.first];
  bool inside = is_inside(composite, inside_leaf, node.first);
  for (uint32_t k = 1; k < node.count; ++k) {
    const bool next = is_inside(composite, inside_leaf, node.first + k);
    inside = node.operation == CompositeNode::Operation::unite       ? inside || next
             : node.operation == CompositeNode::Operation::intersect ? inside && next
                                                                     : inside && !next;
  }
  return inside;
}

Crossings composite_crossings(const Composite& composite, const std::vector<BallMap>& maps, const BallLine& line) {
  Crossings all, out;
  for (size_t k = 0; k < composite.leaves.size(); ++k)
    for (const BallCrossing& c :
         std::visit([&](const auto& body) { return surface_crossings(body, maps[k](line)); }, composite.leaves[k].body))
      all.push_back({c.t, int(k) * kFacesPerLeaf + c.face});
  sort_certainly(all);
  std::vector<bool> inside_leaf(composite.leaves.size(), false);
  bool inside = false;
  for (const BallCrossing& c : all) {
    const auto leaf = size_t(c.face / kFacesPerLeaf);
    inside_leaf[leaf] = !inside_leaf[leaf];
    const bool now = is_inside(composite, inside_leaf);
    if (now != inside) out.push_back(c);
    inside = now;
  }
  return out;
}

Crossings polygon_crossings(const Polygon& polygon, const std::set<std::pair<uint32_t, uint32_t>>& edges,
                            const BallLine& line) {
  const BallVec o = to_plane_axes(line.origin - BallVec(polygon.center), polygon.dropped_axis);
  const BallVec d = to_plane_axes(line.direction, polygon.dropped_axis);
  const auto coefficient = [](const Rational& x) { return sgn(x) == 0 ? Ball() : Ball(x); };
  const Ball slope_x = coefficient(polygon.exact_plane.slope_x), slope_y = coefficient(polygon.exact_plane.slope_y);
  const Ball speed = d.z - slope_x * d.x - slope_y * d.y;
  if (sign(speed) == 0) throw InDoubt();  // along the plane, perhaps within it
  const Ball t = (coefficient(polygon.exact_plane.offset) + slope_x * o.x + slope_y * o.y - o.z) / speed;
  if (!inside_polygon(polygon, edges, o.x + t * d.x, o.y + t * d.y)) return {};
  return {{t, kWallFace}};
}

}  // namespace

BallMap::BallMap(std::span<const Affine3d> chain) {
  for (const Affine3d& m : chain) {
    if (m == Affine3d{}) continue;
    const Vec3<Rational> x = exact(m.x), y = exact(m.y), z = exact(m.z);
    const Vec3<Rational> cx = cross(y, z), cy = cross(z, x), cz = cross(x, y);
    const Rational det = dot(x, cx);
    const auto row = [&](const Vec3<Rational>& c) {
      const auto entry = [&](const Rational& v) { return sgn(v) == 0 ? Ball() : Ball(Rational(v / det)); };
      return BallVec{entry(c.x), entry(c.y), entry(c.z)};
    };
    steps_.push_back({row(cx), row(cy), row(cz), BallVec(m.origin)});
  }
}

BallLine BallMap::operator()(BallLine line) const {
  for (const Step& step : steps_) {
    const auto apply = [&](const BallVec& v) {
      return BallVec{dot(step.row_x, v), dot(step.row_y, v), dot(step.row_z, v)};
    };
    line = {apply(line.origin - step.center), apply(line.direction)};
  }
  return line;
}

BallSurface::BallSurface(const Surface& surface) : surface_(&surface) {
  if (const auto* composite = std::get_if<Composite>(&surface))
    for (const CompositeLeaf& leaf : composite->leaves) leaf_maps_.emplace_back(leaf.chain);
  if (const auto* polygon = std::get_if<Polygon>(&surface))
    for (const Polygon::Edge& edge : polygon->edges)
      edges_.insert({edge.first, edge.second});  // once, though several strips hold it
}

Crossings BallSurface::crossings(const BallLine& line) const {
  return std::visit(
      [&](const auto& s) {
        using S = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<S, Composite>)
          return composite_crossings(s, leaf_maps_, line);
        else if constexpr (std::is_same_v<S, Polygon>)
          return polygon_crossings(s, edges_, line);
        else
          return surface_crossings(s, line);
      },
      *surface_);
}

}  // namespace alhazen::crosscheck
