#include "crosscheck/edge_distance.h"

#include <cmath>

#include "accel/line_map.h"
#include "accel/shapes/polygon_plane.h"

namespace alhazen::crosscheck {
namespace {

constexpr double kNear = 0x1p-10;      // how far off a feature, relative to its size, the line may pass to count
constexpr double kAtVertex = 0x1p-20;  // of an edge's length: what is nearer to its end is the vertex
constexpr double kUnit = 0x1p-24;

using QuadVec = Vec3<Quad>;

struct QuadLine {
  QuadVec origin, direction;
  [[nodiscard]] QuadVec at(Quad t) const { return origin + direction * t; }
};

QuadLine mapped(std::span<const Affine3d> chain, const QuadLine& line) {
  const ObjectLine<Quad> image = object_line(quad_line_map(chain), line.origin, line.direction);
  return {image.origin, image.direction};
}

Quad term_size(const QuadVec& a, const QuadVec& b) {
  return absolute(a.x * b.x) + absolute(a.y * b.y) + absolute(a.z * b.z);
}

/// Keeps the nearest of what it is shown.
class Nearest {
 public:
  void consider(Quad value, Quad terms, const char* feature) {
    const auto ulp = value == 0 ? 0.0 : double(absolute(value) / (terms * Quad(kUnit)));
    if (std::isnan(ulp)) return;
    if (!found_ || ulp < found_->ulp) found_ = {ulp, feature};
  }
  [[nodiscard]] std::optional<EdgeDistance> found() const { return found_; }

 private:
  std::optional<EdgeDistance> found_;
};

/// A body's wall and planes along a line.
class BodyFeatures {
 public:
  BodyFeatures(const QuadricBody<Quad>& body, BodyParts parts, const QuadLine& line, Nearest& nearest)
      : body_(body), parts_(parts), line_(line), nearest_(nearest) {
    const auto form = [&](const QuadVec& v) {
      return QuadVec{body.a * v.x + body.d * v.y + body.e * v.z, body.d * v.x + body.b * v.y + body.f * v.z,
                     body.e * v.x + body.f * v.y + body.c * v.z};
    };
    const QuadVec linear{body.g, body.h, body.i}, form_o = form(line.origin);
    a_ = dot(line.direction, form(line.direction));
    b_ = dot(line.direction, form_o + linear);
    c_ = dot(line.origin, form_o) + 2 * dot(line.origin, linear) + body.j;
  }

  /// `only_axis`: of the planes that touch the body; -1: of all.
  void consider_all(int only_axis = -1) const {
    if (parts_.wall) consider_silhouette();
    if (!parts_.planes) return;
    for (int axis = 0; axis < 3; ++axis)
      if (only_axis < 0 || axis == only_axis)
        for (const Quad plane : {body_.lower[axis], body_.upper[axis]}) consider_plane(axis, plane);
  }

 private:
  [[nodiscard]] bool within_box(Quad t, int but_axis = -1, int but_other = -1) const {
    if (!parts_.planes) return true;
    const QuadVec p = line_.at(t);
    for (int k = 0; k < 3; ++k) {
      const Quad slack = (body_.upper[k] - body_.lower[k]) * Quad(kNear);
      if (k == but_axis || k == but_other) continue;
      if (p[k] < body_.lower[k] - slack || p[k] > body_.upper[k] + slack) return false;
    }
    return true;
  }

  [[nodiscard]] Quad wall_terms(Quad t) const { return absolute(a_ * t * t) + absolute(2 * b_ * t) + absolute(c_); }
  [[nodiscard]] Quad wall(Quad t) const { return (a_ * t + 2 * b_) * t + c_; }

  void consider_silhouette() const {
    if (a_ == 0 || !within_box(-b_ / a_)) return;
    nearest_.consider(b_ * b_ - a_ * c_, b_ * b_ + absolute(a_ * c_), touches_apex(-b_ / a_) ? "apex" : "silhouette");
  }

  /// Cones alone: where the wall's gradient nearly vanishes.
  [[nodiscard]] bool touches_apex(Quad t) const {
    const QuadVec p = line_.at(t), size = body_.upper - body_.lower;
    const bool round = body_.a == body_.c && body_.b < 0 && body_.d == 0 && body_.e == 0 && body_.f == 0;
    return round && absolute(body_.b * p.y + body_.h) < Quad(kNear) * absolute(body_.b * size.y);
  }

  void consider_plane(int axis, Quad plane) const {
    if (line_.direction[axis] == 0) return consider_parallel(axis, plane);
    const Quad t = (plane - line_.origin[axis]) / line_.direction[axis];
    if (parts_.wall && within_box(t, axis)) nearest_.consider(wall(t), wall_terms(t), "rim");
    for (int other = axis + 1; other < 3; ++other)
      for (const Quad second : {body_.lower[other], body_.upper[other]}) consider_pair(axis, t, other, second);
  }

  void consider_pair(int axis, Quad t, int other, Quad plane) const {
    if (line_.direction[other] == 0) return;
    const Quad s = (plane - line_.origin[other]) / line_.direction[other];
    if (!within_box(t, axis, other) || !within_box(s, axis, other)) return;
    if (parts_.wall && wall(t) > wall_terms(t) * Quad(kNear)) return;
    nearest_.consider(t - s, absolute(t) + absolute(s), "edge");
  }

  /// A line along a face passes by at the face's border.
  void consider_parallel(int axis, Quad plane) const {
    const Quad middle = -dot(line_.origin - (body_.lower + body_.upper) * Quad(0.5), line_.direction) /
                        dot(line_.direction, line_.direction);
    if (!within_box(middle, axis)) return;
    nearest_.consider(line_.origin[axis] - plane, absolute(line_.origin[axis]) + absolute(plane), "edge");
  }

  const QuadricBody<Quad>& body_;
  BodyParts parts_;
  const QuadLine& line_;
  Nearest& nearest_;
  Quad a_, b_, c_;
};

void consider(const Sphere& s, const QuadLine& line, Nearest& nearest) {
  BodyFeatures(quadric_body<Quad>(s), {.planes = false, .wall = true}, line, nearest).consider_all();
}
void consider(const Cylinder& s, const QuadLine& line, Nearest& nearest) {
  BodyFeatures(quadric_body<Quad>(s), {}, line, nearest).consider_all(1);
}
void consider(const Quadric& s, const QuadLine& line, Nearest& nearest) {
  BodyFeatures(quadric_body<Quad>(s), {}, line, nearest).consider_all();
}
void consider(const Box& s, const QuadLine& line, Nearest& nearest) {
  BodyFeatures(quadric_body<Quad>(s), {.planes = true, .wall = false}, line, nearest).consider_all();
}

void consider(const Disk& disk, const QuadLine& line, Nearest& nearest) {
  if (line.direction.y == 0)
    return nearest.consider(line.origin.y, absolute(line.origin.y) + Quad(disk.radius), "edge");
  const QuadVec p = line.at(-line.origin.y / line.direction.y);
  const Quad squared = p.x * p.x + p.z * p.z;
  for (const Quad radius : {Quad(disk.radius), Quad(disk.inner_radius)})
    if (radius > 0) nearest.consider(radius * radius - squared, radius * radius + squared, "rim");
}

/// `along`: where between the ends the line passes, 0 to 1; further off it is not this edge that is near.
void consider_edge(Quad value, Quad terms, Quad along, Nearest& nearest) {
  if (along < Quad(-kNear) || along > Quad(1 + kNear)) return;
  const Quad from_end = smaller(absolute(along), absolute(Quad(1) - along));
  nearest.consider(value, terms, from_end < Quad(kAtVertex) ? "vertex" : "edge");
}

void consider(const Triangle& triangle, const QuadLine& line, Nearest& nearest) {
  const QuadVec corners[] = {QuadVec(triangle.a) - line.origin, QuadVec(triangle.b) - line.origin,
                             QuadVec(triangle.c) - line.origin};
  const QuadVec n = cross(corners[1] - corners[0], corners[2] - corners[0]), &d = line.direction;
  const Quad speed = dot(n, d);
  for (int k = 0; k < 3; ++k) {
    const QuadVec &p = corners[k], &q = corners[(k + 1) % 3];
    const QuadVec spread{absolute(p.y * q.z) + absolute(p.z * q.y), absolute(p.z * q.x) + absolute(p.x * q.z),
                         absolute(p.x * q.y) + absolute(p.y * q.x)};
    const QuadVec met = speed == 0 ? p : d * (dot(n, p) / speed);
    const Quad along = dot(met - p, q - p) / dot(q - p, q - p);
    consider_edge(dot(d, cross(p, q)), term_size(d, spread), along, nearest);
  }
}

void consider(const Polygon& polygon, const QuadLine& line, Nearest& nearest) {
  const HeightPlane<Quad>& plane = polygon.quad_plane;
  const QuadVec o = to_plane_axes(line.origin - QuadVec(polygon.center), polygon.dropped_axis);
  const QuadVec d = to_plane_axes(line.direction, polygon.dropped_axis);
  const Quad speed = d.z - plane.slope_x * d.x - plane.slope_y * d.y;
  if (speed == 0) return;
  const QuadVec p = o + d * ((plane.offset + plane.slope_x * o.x + plane.slope_y * o.y - o.z) / speed);
  for (const Polygon::Edge& edge : polygon.edges) {
    const auto vertex = [&](uint32_t k) {
      return to_plane_axes(QuadVec(polygon.vertices[k]) - QuadVec(polygon.center), polygon.dropped_axis);
    };
    const QuadVec a = vertex(edge.first), b = vertex(edge.second);
    const Quad ex = b.x - a.x, ey = b.y - a.y, px = p.x - a.x, py = p.y - a.y;
    const Quad terms = absolute(ex) * (absolute(p.y) + absolute(a.y)) + absolute(ey) * (absolute(p.x) + absolute(a.x));
    consider_edge(ex * py - ey * px, terms, (px * ex + py * ey) / (ex * ex + ey * ey), nearest);
  }
}

ExactLine exactly(const QuadLine& line) {
  const auto number = [](Quad x) {
    const auto high = double(x);
    return Rational(exact(high) + exact(double(x - Quad(high))));
  };
  const auto vector = [&](const QuadVec& v) { return Vec3<Rational>{number(v.x), number(v.y), number(v.z)}; };
  return {vector(line.origin), vector(line.direction)};
}

/// Of each operand, and where two of them meet.
void consider(const Composite& composite, const QuadLine& line, Nearest& nearest) {
  std::vector<Quad> met;
  for (const CompositeLeaf& leaf : composite.leaves) {
    const QuadLine own = mapped(leaf.chain, line);
    std::visit([&](const auto& body) { consider(body, own, nearest); }, leaf.body);
    const size_t before = met.size();
    for (const ExactCrossing& c :
         std::visit([&](const auto& body) { return exact_crossings(body, exactly(own)); }, leaf.body)) {
      const Quad t = to_quad(c.t);
      for (size_t k = 0; k < before; ++k) nearest.consider(t - met[k], absolute(t) + absolute(met[k]), "edge");
      met.push_back(t);
    }
  }
}

bool meets(const Subject& subject, const Rayf& ray) {
  const ExactLine line = exact_line({&subject.world_from_object, 1}, exact_line(ray));
  return !std::visit([&](const auto& s) { return exact_crossings(s, line); }, subject.surface).empty();
}

}  // namespace

std::optional<EdgeDistance> edge_distance(const Subject& subject, const Rayf& ray) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3f{}) return std::nullopt;
  const QuadLine line =
      mapped({&subject.world_from_object, 1}, {QuadVec(Vec3d(ray.origin)), QuadVec(Vec3d(ray.direction))});
  Nearest nearest;
  std::visit([&](const auto& s) { consider(s, line, nearest); }, subject.surface);
  std::optional<EdgeDistance> found = nearest.found();
  if (found && !std::isfinite(found->ulp)) return std::nullopt;
  if (found && !meets(subject, ray)) found->ulp = -found->ulp;
  return found;
}

}  // namespace alhazen::crosscheck
