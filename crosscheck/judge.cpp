#include "crosscheck/judge.h"

#include "crosscheck/ball_crossings.h"

namespace alhazen::crosscheck {
namespace {

constexpr double kGrazing = 1e-9;  // a side is not judged where the ray runs flatter than this

Vec3d face_normal(int face) {
  const double outward = face & 1 ? 1 : -1;
  return face < 2 ? Vec3d{outward, 0, 0} : face < 4 ? Vec3d{0, outward, 0} : Vec3d{0, 0, outward};
}

/// The gradient of a body's wall.
Vec3d wall_normal(const QuadricBody<double>& q, const Vec3d& p) {
  return {q.a * p.x + q.d * p.y + q.e * p.z + q.g, q.d * p.x + q.b * p.y + q.f * p.z + q.h,
          q.e * p.x + q.f * p.y + q.c * p.z + q.i};
}

template <class S>
Vec3d true_normal(const S& body, const Vec3d& p, int face) {
  return face == kWallFace ? wall_normal(quadric_body<double>(body), p) : face_normal(face);
}
Vec3d true_normal(const Disk&, const Vec3d&, int) { return {0, 1, 0}; }
Vec3d true_normal(const Triangle& t, const Vec3d&, int) { return cross(t.b - t.a, t.c - t.a); }
Vec3d true_normal(const Polygon& polygon, const Vec3d&, int) {
  const double sx = polygon.exact_plane.slope_x.get_d(), sy = polygon.exact_plane.slope_y.get_d();
  const int k = polygon.dropped_axis;
  const Vec3d n = k == 0 ? Vec3d{1, -sx, -sy} : k == 1 ? Vec3d{-sy, 1, -sx} : Vec3d{-sx, -sy, 1};
  return polygon.unit_normal[k] < 0 ? -n : n;
}
Vec3d true_normal(const Composite& composite, const Vec3d& p_object, int face) {
  const CompositeLeaf& leaf = composite.leaves[size_t(face / kFacesPerLeaf)];
  Vec3d p = p_object;
  for (const Affine3d& m : leaf.chain) p = transform_point(inverse(m), p);
  Vec3d n = std::visit([&](const auto& body) { return true_normal(body, p, face % kFacesPerLeaf); }, leaf.body);
  for (size_t k = leaf.chain.size(); k-- > 0;) n = transform_normal(leaf.chain[k], n);
  return leaf.reversed ? -n : n;
}

Vec3d unit_normal(const Surface& surface, const Vec3d& p, int face) {
  const Vec3d n = std::visit([&](const auto& s) { return true_normal(s, p, face); }, surface);
  const double size = max_component(abs(n));
  return size > 0 && is_finite(n) ? normalize(n / size) : Vec3d{};
}

Vec3d to_double(const Vec3<Ball>& v) { return {double(v.x.mid), double(v.y.mid), double(v.z.mid)}; }

bool in_range(float t, const Rayf& ray) { return t >= ray.t_min && t <= ray.t_max; }

}  // namespace

struct Judge::Impl {
  Subject subject;
  BallSurface surface;
  BallMap map;

  explicit Impl(const Subject& s) : subject(s), surface(subject.surface), map({&subject.world_from_object, 1}) {}

  [[nodiscard]] BallLine object_line(const Rayf& ray) const {
    return map({Vec3<Ball>(Vec3d(ray.origin)), Vec3<Ball>(Vec3d(ray.direction))});
  }

  /// What follows from where the hit is: the side, and the normal.
  void describe(const BallLine& line, Quad t, Judgement& j) const {
    const Vec3<Quad> p{line.origin.x.mid + t * line.direction.x.mid, line.origin.y.mid + t * line.direction.y.mid,
                       line.origin.z.mid + t * line.direction.z.mid};
    const Vec3d p_object{double(p.x), double(p.y), double(p.z)}, d = to_double(line.direction);
    j.normal_object = unit_normal(subject.surface, p_object, j.face);
    const double d_size = max_component(abs(d)), across = dot(j.normal_object, d / d_size);
    const double off = std::abs(double(t)) * d_size * 0x1p-22 + max_component(abs(to_double(line.origin))) * 1e-13;
    j.normal_tolerance = 1e-9;
    for (const Vec3d& step : {Vec3d{off, 0, 0}, Vec3d{0, off, 0}, Vec3d{0, 0, off}}) {
      const Vec3d turned = unit_normal(subject.surface, p_object + step, j.face);
      j.normal_tolerance = std::max(j.normal_tolerance, 3 * length(turned - j.normal_object));
    }
    j.side = std::abs(across) > kGrazing + j.normal_tolerance ? (across < 0 ? -1 : 1) : 0;
  }

  [[nodiscard]] Judgement by_balls(const Rayf& ray) const {
    const BallLine line = object_line(ray);
    Judgement j;
    for (const BallCrossing& c : surface.crossings(line)) {
      const float t = to_float(c.t);
      if (!in_range(t, ray)) continue;
      j.hit = true, j.t = t, j.face = c.face;
      describe(line, c.t.mid, j);
      break;
    }
    return j;
  }

  [[nodiscard]] Judgement by_rationals(const Rayf& ray) const {
    const ExactLine line = exact_line({&subject.world_from_object, 1}, exact_line(ray));
    Judgement j;
    j.by_rationals = true;
    j.tie = tie_of(subject.surface, line);
    for (const ExactCrossing& c :
         std::visit([&](const auto& s) { return exact_crossings(s, line); }, subject.surface)) {
      const float t = alhazen::to_float(c.t);
      if (!in_range(t, ray)) continue;
      j.hit = true, j.t = t, j.face = c.face;
      describe(object_line(ray), to_quad(c.t), j);
      break;
    }
    return j;
  }
};

Judge::Judge(const Subject& subject) : impl_(std::make_unique<Impl>(subject)) {}
Judge::~Judge() = default;

Judgement Judge::closest(const Rayf& ray) const {
  try {
    return impl_->by_balls(ray);
  } catch (const InDoubt&) {
    return impl_->by_rationals(ray);
  }
}

Judgement Judge::closest_exactly(const Rayf& ray) const { return impl_->by_rationals(ray); }

}  // namespace alhazen::crosscheck
