#include "crosscheck/judge.h"

#include "crosscheck/ball_crossings.h"

namespace alhazen::crosscheck {
namespace {

constexpr double kGrazing = 1e-9;           // a side is not judged where the ray runs flatter than this
constexpr double kLeastGradient = 0x1p-22;  // of its terms: what is less has lost too many of their bits
constexpr double kGradientAngle = 0x1p-28;  // radians: by how much a dozen roundings of the terms turn the rest

Vec3d face_normal(int face) {
  const double outward = face & 1 ? 1 : -1;
  return face < 2 ? Vec3d{outward, 0, 0} : face < 4 ? Vec3d{0, outward, 0} : Vec3d{0, 0, outward};
}

/// The gradient of a body's wall, to kGradientAngle; zero where its terms cancel too far for that: there is none at an
/// apex, and beside one the roundings of the terms would turn it.
Vec3d wall_normal(const QuadricBody<double>& q, const Vec3d& p) {
  const auto gradient = [](const Vec3d& rows_x, const Vec3d& rows_y, const Vec3d& rows_z, const Vec3d& at,
                           const Vec3d& linear) {
    return Vec3d{dot(rows_x, at), dot(rows_y, at), dot(rows_z, at)} + linear;
  };
  const Vec3d x{q.a, q.d, q.e}, y{q.d, q.b, q.f}, z{q.e, q.f, q.c}, linear{q.g, q.h, q.i};
  const Vec3d n = gradient(x, y, z, p, linear), terms = gradient(abs(x), abs(y), abs(z), abs(p), abs(linear));
  return max_component(abs(n)) > kLeastGradient * max_component(terms) ? n : Vec3d{};
}

/// The normal at p, or `off` beside it in the space of the body that has the face.
template <class S>
Vec3d true_normal(const S& body, const Vec3d& p, int face, const Vec3d& off) {
  return face == kWallFace ? wall_normal(quadric_body<double>(body), p + off) : face_normal(face);
}
Vec3d true_normal(const Disk&, const Vec3d&, int, const Vec3d&) { return {0, 1, 0}; }
Vec3d true_normal(const Triangle& t, const Vec3d&, int, const Vec3d&) { return cross(t.b - t.a, t.c - t.a); }
Vec3d true_normal(const Polygon& polygon, const Vec3d&, int, const Vec3d&) {
  const double sx = polygon.exact_plane.slope_x.get_d(), sy = polygon.exact_plane.slope_y.get_d();
  const int k = polygon.dropped_axis;
  const Vec3d n = k == 0 ? Vec3d{1, -sx, -sy} : k == 1 ? Vec3d{-sy, 1, -sx} : Vec3d{-sx, -sy, 1};
  return polygon.unit_normal[k] < 0 ? -n : n;
}
/// What is as long as `off` in the composite may be as long there as the longest of the chain's images of its axes.
Vec3d true_normal(const Composite& composite, const Vec3d& p_object, int face, const Vec3d& off) {
  const CompositeLeaf& leaf = composite.leaves[size_t(face / kFacesPerLeaf)];
  Vec3d p = p_object;
  std::array<Vec3d, 3> axes = {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  for (const Affine3d& m : leaf.chain) {
    p = transform_point(inverse(m), p);
    for (Vec3d& axis : axes) axis = transform_vector(inverse(m), axis);
  }
  const Vec3d off_leaf = off * std::max({length(axes[0]), length(axes[1]), length(axes[2])});
  Vec3d n =
      std::visit([&](const auto& body) { return true_normal(body, p, face % kFacesPerLeaf, off_leaf); }, leaf.body);
  for (size_t k = leaf.chain.size(); k-- > 0;) n = transform_normal(leaf.chain[k], n);
  return leaf.reversed ? -n : n;
}

Vec3d unit_normal(const Surface& surface, const Vec3d& p, int face, const Vec3d& off = {}) {
  const Vec3d n = std::visit([&](const auto& s) { return true_normal(s, p, face, off); }, surface);
  const double size = max_component(abs(n));
  return size > 0 && is_finite(n) ? normalize(n / size) : Vec3d{};
}

/// Barycentric weights of a point of the triangle.
void weigh(const Triangle& t, const Vec3d& p, Judgement& j) {
  const Vec3d n = cross(t.b - t.a, t.c - t.a);
  j.u = dot(cross(p - t.a, t.c - t.a), n) / dot(n, n), j.v = dot(cross(t.b - t.a, p - t.a), n) / dot(n, n);
}

bool in_range(float t, const Rayf& ray) { return t >= ray.t_min && t <= ray.t_max; }

/// The surface and its place in one of the interval arithmetics.
template <class N>
class BallInstance {
 public:
  explicit BallInstance(const Subject& subject) : surface_(subject.surface), map_({&subject.world_from_object, 1}) {}

  [[nodiscard]] BallLine<N> object_line(const Rayf& ray) const {
    return map_({Vec3<Ball<N>>(Vec3d(ray.origin)), Vec3<Ball<N>>(Vec3d(ray.direction))});
  }
  /// The first in range. Throws InDoubt.
  [[nodiscard]] std::optional<BallCrossing<N>> closest(const BallLine<N>& line, const Rayf& ray, float& t) const {
    thread_local std::vector<BallCrossing<N>> crossings;
    crossings.clear();
    surface_.append_crossings(line, crossings);
    for (const BallCrossing<N>& c : crossings)
      if (t = to_float(c.t); in_range(t, ray)) return c;
    return {};
  }

 private:
  BallSurface<N> surface_;
  BallMap<N> map_;
};

}  // namespace

struct Judge::Impl {
  Subject subject;
  BallInstance<double> by_doubles;
  BallInstance<DoubleDouble> by_double_doubles;

  explicit Impl(const Subject& s) : subject(s), by_doubles(subject), by_double_doubles(subject) {}

  /// What follows from where the hit is: the side, and the normal.
  template <class N>
  void describe(const BallLine<N>& line, N t, Judgement& j) const {
    const auto at = [&](int k) { return double(line.origin[k].mid + t * line.direction[k].mid); };
    const auto size = [](const Vec3<Ball<N>>& v) {
      return max_component(abs(Vec3d{double(v.x.mid), double(v.y.mid), double(v.z.mid)}));
    };
    const Vec3d p_object{at(0), at(1), at(2)};
    const Vec3d d{double(line.direction.x.mid), double(line.direction.y.mid), double(line.direction.z.mid)};
    j.normal_object = unit_normal(subject.surface, p_object, j.face);
    if (const auto* triangle = std::get_if<Triangle>(&subject.surface)) weigh(*triangle, p_object, j);
    const double d_size = size(line.direction), across = dot(j.normal_object, d / d_size);
    const double off = std::abs(double(t)) * d_size * 0x1p-22 + size(line.origin) * 1e-13;
    // A point that a rounding of t has taken off the surface is put back in the body's space, in whatever direction.
    j.normal_tolerance = kGradientAngle;
    for (const Vec3d& step : {Vec3d{off, 0, 0}, Vec3d{0, off, 0}, Vec3d{0, 0, off}}) {
      const Vec3d turned = unit_normal(subject.surface, p_object, j.face, step);
      j.normal_tolerance = std::max(j.normal_tolerance, 3 * length(turned - j.normal_object));
    }
    j.side = std::abs(across) > kGrazing + j.normal_tolerance ? (across < 0 ? -1 : 1) : 0;
  }

  template <class N>
  [[nodiscard]] Judgement by_balls(const BallInstance<N>& instance, const Rayf& ray) const {
    const BallLine<N> line = instance.object_line(ray);
    Judgement j;
    float t;
    if (const auto c = instance.closest(line, ray, t)) {
      j.hit = true, j.t = t, j.face = c->face;
      describe(line, c->t.mid, j);
    }
    return j;
  }

  [[nodiscard]] Judgement by_rationals(const Rayf& ray) const {
    const ExactLine line = exact_line({&subject.world_from_object, 1}, exact_line(ray));
    Judgement j;
    j.by = JudgedBy::rationals;
    j.tie = tie_of(subject.surface, line);
    for (const ExactCrossing& c :
         std::visit([&](const auto& s) { return exact_crossings(s, line); }, subject.surface)) {
      const float t = alhazen::to_float(c.t);
      if (!in_range(t, ray)) continue;
      j.hit = true, j.t = t, j.face = c.face;
      describe(by_double_doubles.object_line(ray), DoubleDouble(double(to_quad(c.t))), j);
      break;
    }
    return j;
  }
};

Judge::Judge(const Subject& subject) : impl_(std::make_unique<Impl>(subject)) {}
Judge::~Judge() = default;

Judgement Judge::closest(const Rayf& ray) const {
  try {
    return impl_->by_balls(impl_->by_doubles, ray);
  } catch (const InDoubt&) {
  }
  try {
    Judgement j = impl_->by_balls(impl_->by_double_doubles, ray);
    j.by = JudgedBy::double_doubles;
    return j;
  } catch (const InDoubt&) {
    return impl_->by_rationals(ray);
  }
}

Judgement Judge::closest_exactly(const Rayf& ray) const { return impl_->by_rationals(ray); }

}  // namespace alhazen::crosscheck
