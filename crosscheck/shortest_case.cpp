#include "crosscheck/shortest_case.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "crosscheck/shrink.h"
#include "crosscheck/subject_check.h"

namespace alhazen::crosscheck {
namespace {

constexpr int kMostTries = 20000;         // takes seconds
constexpr uint64_t kMostWork = 40000000;  // of tries times complexity, for the largest polygons

/// What `stated_case` reads.
Json case_json(Subject subject, const Rayf& ray, bool robust_native) {
  subject.origin.clear();
  return {{"subject", to_json(subject)},
          {"ray", to_json(ray)},
          {"embree", {{"scene_flags_B", robust_native ? "robust" : "none"}}}};
}

/// Of the same kind.
bool same_fault(const Case& found, const Case& c, Blamed blamed) {
  if (found.truth.tie != c.truth.tie) return false;
  if (blamed == Blamed::a) return found.a_fault == c.a_fault;
  return found.a_fault == Fault::none && found.b_fault == c.b_fault;
}

/// Where on the ray something happens: what the parties say, or the point nearest to the subject's own origin.
std::vector<double> places_of(const Case& c) {
  const Vec3d o = Vec3d(c.ray.origin) - c.subject->world_from_object.origin, d(c.ray.direction);
  std::vector<double> places{-dot(o, d) / dot(d, d)};
  if (c.truth.hit) places.push_back(double(c.truth.t));
  if (c.a.hit) places.push_back(double(c.a.t));
  return places;
}

/// Changes of several numbers at once that keep what happens, nearly: the simpler ones are tried.
class CaseRewrites {
 public:
  CaseRewrites(const Case& c, bool fixed_subject) : c_(c), fixed_subject_(fixed_subject) {}

  std::vector<Json> operator()() {
    bring_home();
    for (const double t : places_of(c_)) slide(t), turn(t);
    shorten_direction();
    align();
    return std::move(list_);
  }

 private:
  void add(const Subject& subject, const Vec3d& origin, const Vec3d& direction, double t_min, double t_max) {
    list_.push_back(
        case_json(subject, {Vec3f(origin), Vec3f(direction), float(t_min), float(t_max)}, c_.robust_native));
  }

  /// Into the subject's own space, and at least to its place.
  void bring_home() {
    if (fixed_subject_) return;
    const Affine3d& m = c_.subject->world_from_object;
    Subject home = *c_.subject;
    home.world_from_object = {};
    const Affine3d to_home = inverse(m);
    add(home, transform_point(to_home, Vec3d(c_.ray.origin)), transform_vector(to_home, Vec3d(c_.ray.direction)),
        c_.ray.t_min, c_.ray.t_max);
    home.world_from_object = {m.x, m.y, m.z, {}};
    add(home, Vec3d(c_.ray.origin) - m.origin, Vec3d(c_.ray.direction), c_.ray.t_min, c_.ray.t_max);
  }

  /// The origin along the ray, to where `t` is one or two.
  void slide(double t) {
    const Vec3d o(c_.ray.origin), d(c_.ray.direction);
    for (const double left : {0.0, 1.0, 2.0}) add(*c_.subject, o + d * (t - left), d, c_.ray.t_min, c_.ray.t_max);
  }

  /// Along one axis, or two, through the same point.
  void turn(double t) {
    const Vec3d o(c_.ray.origin), d(c_.ray.direction), p = o + d * t;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3d kept{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
      for (const Vec3d& turned : {d * kept, d - d * kept, kept, -kept})
        add(*c_.subject, p - turned * t, turned, c_.ray.t_min, c_.ray.t_max);
    }
  }

  /// Along the z axis, as far from the subject's own origin as it was: what touches a round body still does.
  void align() {
    const Vec3d o = Vec3d(c_.ray.origin) - c_.subject->world_from_object.origin, d(c_.ray.direction);
    const Vec3d nearest = o - d * (dot(o, d) / dot(d, d));
    const double away = std::exp2(std::ceil(std::log2(length(o - nearest))));
    for (const double z : {away, away / 2, length(o - nearest)})
      for (const int floats : {0, -1, 1, -2, 2, -3, 3}) {
        const auto x = double(moved_by_floats(float(length(nearest)), floats));
        add(*c_.subject, c_.subject->world_from_object.origin + Vec3d{x, 0, -z}, {0, 0, 1}, c_.ray.t_min, c_.ray.t_max);
      }
  }

  /// By a power of two.
  void shorten_direction() {
    const double factor = std::exp2(-std::ilogb(max_component(abs(Vec3d(c_.ray.direction)))));
    add(*c_.subject, Vec3d(c_.ray.origin), Vec3d(c_.ray.direction) * factor, c_.ray.t_min / factor,
        c_.ray.t_max / factor);
  }

  const Case& c_;
  bool fixed_subject_;
  std::vector<Json> list_;
};

/// A document read and judged; the subject lives here.
struct Judged {
  Subject subject;
  Case c;
};

std::unique_ptr<Judged> judged(const Json& document, const Options& options) {
  try {
    StatedCase stated = stated_case(document, "");
    auto result = std::make_unique<Judged>(Judged{std::move(stated.subject), {}});
    result->c = judge_alone(result->subject, stated.ray, stated.robust_native, options);
    return result;
  } catch (const Error&) {
    return nullptr;  // makes no sense, or reaches too far
  }
}

}  // namespace

std::optional<Json> shortest_case(const Case& c, Blamed blamed, const Options& options) {
  const bool faulty = blamed == Blamed::a ? c.a_fault != Fault::none : c.b_fault.value_or(Fault::none) != Fault::none;
  if (!faulty || !c.subject) return std::nullopt;
  const Json start = case_json(*c.subject, c.ray, c.robust_native);
  const Holds holds = [&](const Json& document) {
    if (options.intersector && document["subject"] != start["subject"]) return false;
    const auto found = judged(document, options);
    return found && same_fault(found->c, c, blamed);
  };
  const Rewrites rewrites = [&](const Json& document) {
    const auto found = judged(document, options);
    return found ? CaseRewrites(found->c, options.intersector != nullptr)() : std::vector<Json>();
  };
  if (!holds(start)) return std::nullopt;
  return shrunk(start, holds, rewrites, int(std::min(uint64_t(kMostTries), kMostWork / complexity(start))));
}

}  // namespace alhazen::crosscheck
