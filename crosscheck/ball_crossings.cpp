#include "crosscheck/ball_crossings.h"

#include <algorithm>
#include <set>

#include "accel/shapes/polygon_plane.h"

namespace alhazen::crosscheck {
namespace {

template <class N>
using BallVec = Vec3<Ball<N>>;

/// Insertion by certain comparisons; two at one place are in doubt.
template <class N>
void sort_certainly(std::span<BallCrossing<N>> list) {
  for (size_t i = 1; i < list.size(); ++i)
    for (size_t k = i; k > 0; --k) {
      const int order = sign(list[k].t - list[k - 1].t);
      if (order == 0) throw InDoubt();
      if (order > 0) break;
      std::swap(list[k], list[k - 1]);
    }
}

/// A wall's two and the planes of a box.
template <class N>
class BodyCandidates {
 public:
  void add(const Ball<N>& t, int face) { at_[count_++] = {t, face}; }
  [[nodiscard]] std::span<BallCrossing<N>> all() { return {at_.data(), count_}; }

 private:
  std::array<BallCrossing<N>, 8> at_;
  size_t count_ = 0;
};

/// A body cut by a line: polynomials in the line's parameter.
template <class N>
class BodyLine {
 public:
  using B = Ball<N>;

  BodyLine(const QuadricBody<B>& body, BodyParts parts, const BallLine<N>& line)
      : body_(body), parts_(parts), line_(line) {
    if (!parts.wall) return;
    const auto form = [&](const BallVec<N>& v) {
      return BallVec<N>{body.a * v.x + body.d * v.y + body.e * v.z, body.d * v.x + body.b * v.y + body.f * v.z,
                        body.e * v.x + body.f * v.y + body.c * v.z};
    };
    const BallVec<N> linear{body.g, body.h, body.i}, form_o = form(line.origin);
    a_ = dot(line.direction, form(line.direction));
    b_ = dot(line.direction, form_o + linear);
    c_ = dot(line.origin, form_o) + B(2.0) * dot(line.origin, linear) + body.j;
  }

  /// Every parameter at which the line may change from inside to outside, ascending.
  [[nodiscard]] BodyCandidates<N> candidates() const {
    BodyCandidates<N> list;
    if (parts_.wall) add_wall(list);
    if (parts_.planes)
      for (int axis = 0; axis < 3; ++axis) add_planes(axis, list);
    sort_certainly(list.all());
    return list;
  }

  [[nodiscard]] bool inside_wall(const B& t) const {
    if (!parts_.wall) return true;
    const int s = sign((a_ * t + B(2.0) * b_) * t + c_);
    if (s == 0) throw InDoubt();  // between its roots: the line runs within the wall
    return s < 0;
  }
  [[nodiscard]] bool inside_box(const B& t) const {
    if (!parts_.planes) return true;
    for (int axis = 0; axis < 3; ++axis) {
      const B p = line_.origin[axis] + t * line_.direction[axis];
      const int above = sign(p - body_.lower[axis]), below = sign(body_.upper[axis] - p);
      if (above == 0 || below == 0) throw InDoubt();  // along a plane
      if (above < 0 || below < 0) return false;
    }
    return true;
  }

 private:
  void add_wall(BodyCandidates<N>& list) const {
    if (sign(a_) == 0) {
      if (sign(b_) != 0) list.add(-c_ / (B(2.0) * b_), kWallFace);
      return;
    }
    const B discriminant = b_ * b_ - a_ * c_;
    const int s = sign(discriminant);
    if (s == 0) throw InDoubt();  // tangent
    if (s < 0) return;
    const B root = square_root(discriminant);
    list.add((-b_ - root) / a_, kWallFace);
    list.add((-b_ + root) / a_, kWallFace);
  }
  void add_planes(int axis, BodyCandidates<N>& list) const {
    if (sign(line_.direction[axis]) == 0) return;
    list.add((body_.lower[axis] - line_.origin[axis]) / line_.direction[axis], 2 * axis);
    list.add((body_.upper[axis] - line_.origin[axis]) / line_.direction[axis], 2 * axis + 1);
  }

  const QuadricBody<B>& body_;
  BodyParts parts_;
  const BallLine<N>& line_;
  B a_, b_, c_;
};

/// Solid: where membership changes. Open: where the wall is met inside the box.
template <class N>
void append_body(const QuadricBody<Ball<N>>& body, BodyParts parts, const BallLine<N>& line,
                 std::vector<BallCrossing<N>>& out) {
  const BodyLine<N> cut(body, parts, line);
  BodyCandidates<N> candidates = cut.candidates();
  const std::span<BallCrossing<N>> all = candidates.all();
  if (!body.solid) {
    for (const BallCrossing<N>& c : all)
      if (c.face == kWallFace && cut.inside_box(c.t)) out.push_back(c);
    return;
  }
  bool inside = false;
  for (size_t k = 0; k < all.size(); ++k) {
    const bool last = k + 1 == all.size();
    const Ball<N> middle = last ? Ball<N>() : (all[k].t + all[k + 1].t) * Ball<N>(0.5);
    const bool now = !last && cut.inside_box(middle) && cut.inside_wall(middle);
    if (now != inside) out.push_back(all[k]);
    inside = now;
  }
}

template <class N, class S>
void append(const S& body, const BallLine<N>& line, std::vector<BallCrossing<N>>& out) {
  constexpr bool kPlanes = !std::is_same_v<S, Sphere>, kWall = !std::is_same_v<S, Box>;
  append_body(quadric_body<Ball<N>>(body), {.planes = kPlanes, .wall = kWall}, line, out);
}

template <class N>
void append(const Disk& disk, const BallLine<N>& line, std::vector<BallCrossing<N>>& out) {
  using B = Ball<N>;
  if (sign(line.direction.y) == 0) return sign(line.origin.y) == 0 ? throw InDoubt() : void();
  const B t = -line.origin.y / line.direction.y;
  const B x = line.origin.x + t * line.direction.x, z = line.origin.z + t * line.direction.z;
  const B squared = x * x + z * z, outer = B(disk.radius) * B(disk.radius);
  const B inner = B(disk.inner_radius) * B(disk.inner_radius);
  const int below_outer = sign(outer - squared), above_inner = inner.is_zero() ? 1 : sign(squared - inner);
  if (below_outer == 0 || above_inner == 0) throw InDoubt();
  if (below_outer > 0 && above_inner > 0) out.push_back({t, 3});
}

template <class N>
void append(const Triangle& triangle, const BallLine<N>& line, std::vector<BallCrossing<N>>& out) {
  const auto seen = [&](const Vec3d& p) { return BallVec<N>(p) - line.origin; };
  const BallVec<N> a = seen(triangle.a), b = seen(triangle.b), c = seen(triangle.c);
  const auto side = [&](const BallVec<N>& p, const BallVec<N>& q) {
    const int s = sign(dot(line.direction, cross(p, q)));
    if (s == 0) throw InDoubt();
    return s;
  };
  const int ab = side(a, b), bc = side(b, c);
  if (ab != bc || side(c, a) != ab) return;
  const BallVec<N> n = cross(b - a, c - a);
  const Ball<N> speed = dot(n, line.direction);
  if (sign(speed) == 0) throw InDoubt();
  out.push_back({dot(n, a) / speed, kWallFace});
}

/// Even-odd, by the edges that cross the horizontal line through the point to its right.
template <class N>
bool is_inside(const typename BallSurface<N>::PlanePolygon& polygon, const Ball<N>& x, const Ball<N>& y) {
  bool inside = false;
  for (const auto& [a, b] : polygon.edges) {
    const int above_a = sign(y - a.y), above_b = sign(y - b.y);
    if (above_a == 0 || above_b == 0) throw InDoubt();
    if (above_a == above_b) continue;
    const int side = sign((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x));
    if (side == 0) throw InDoubt();
    if ((side > 0) == (above_a > 0)) inside = !inside;
  }
  return inside;
}

template <class N>
void append_polygon(const typename BallSurface<N>::PlanePolygon& polygon, int dropped_axis, const BallLine<N>& line,
                    std::vector<BallCrossing<N>>& out) {
  const BallVec<N> o = to_plane_axes(line.origin - polygon.center, dropped_axis);
  const BallVec<N> d = to_plane_axes(line.direction, dropped_axis);
  const Ball<N> speed = d.z - polygon.slope_x * d.x - polygon.slope_y * d.y;
  if (sign(speed) == 0) throw InDoubt();  // along the plane, perhaps within it
  const Ball<N> t = (polygon.offset + polygon.slope_x * o.x + polygon.slope_y * o.y - o.z) / speed;
  if (is_inside<N>(polygon, o.x + t * d.x, o.y + t * d.y)) out.push_back({t, kWallFace});
}

template <class N>
typename BallSurface<N>::PlanePolygon plane_polygon(const Polygon& polygon) {
  const BallVec<N> center(polygon.center);
  const auto vertex = [&](uint32_t k) {
    const BallVec<N> p = to_plane_axes(BallVec<N>(polygon.vertices[k]) - center, polygon.dropped_axis);
    return typename BallSurface<N>::PlanePolygon::Point{p.x, p.y};
  };
  const auto& plane = polygon.exact_plane;
  typename BallSurface<N>::PlanePolygon out{
      center, Ball<N>(plane.slope_x), Ball<N>(plane.slope_y), Ball<N>(plane.offset), {}};
  std::set<std::pair<uint32_t, uint32_t>> edges;  // each once, though several strips hold it
  for (const Polygon::Edge& edge : polygon.edges)
    if (edges.insert({edge.first, edge.second}).second) out.edges.push_back({vertex(edge.first), vertex(edge.second)});
  return out;
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

template <class N>
void append_composite(const Composite& composite, const std::vector<BallMap<N>>& maps, const BallLine<N>& line,
                      std::vector<BallCrossing<N>>& out) {
  thread_local std::vector<BallCrossing<N>> all;
  all.clear();
  for (size_t k = 0; k < composite.leaves.size(); ++k) {
    const size_t first = all.size();
    std::visit([&](const auto& body) { append(body, maps[k](line), all); }, composite.leaves[k].body);
    for (size_t c = first; c < all.size(); ++c) all[c].face += int(k) * kFacesPerLeaf;
  }
  sort_certainly(std::span(all));
  std::vector<bool> inside_leaf(composite.leaves.size(), false);
  bool inside = false;
  for (const BallCrossing<N>& c : all) {
    const auto leaf = size_t(c.face / kFacesPerLeaf);
    inside_leaf[leaf] = !inside_leaf[leaf];
    const bool now = is_inside(composite, inside_leaf);
    if (now != inside) out.push_back(c);
    inside = now;
  }
}

}  // namespace

template <class N>
BallSurface<N>::BallSurface(const Surface& surface) : surface_(&surface) {
  if (const auto* composite = std::get_if<Composite>(&surface))
    for (const CompositeLeaf& leaf : composite->leaves) leaf_maps_.emplace_back(leaf.chain);
  if (const auto* polygon = std::get_if<Polygon>(&surface)) polygon_ = plane_polygon<N>(*polygon);
}

template <class N>
void BallSurface<N>::append_crossings(const BallLine<N>& line, std::vector<BallCrossing<N>>& out) const {
  std::visit(
      [&](const auto& s) {
        using S = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<S, Composite>)
          append_composite(s, leaf_maps_, line, out);
        else if constexpr (std::is_same_v<S, Polygon>)
          append_polygon<N>(polygon_, s.dropped_axis, line, out);
        else
          append(s, line, out);
      },
      *surface_);
}

template class BallSurface<double>;
template class BallSurface<DoubleDouble>;

}  // namespace alhazen::crosscheck
