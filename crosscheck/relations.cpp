#include "crosscheck/relations.h"

#include <algorithm>
#include <cmath>

#include "crosscheck/exact_ties.h"
#include "crosscheck/verdict.h"

namespace alhazen::crosscheck {
namespace {

constexpr double kLeast = 1e-30, kLargest = 1e30;  // parameters that powers of two scale without loss

bool scales(const Answer& answer) {
  const auto t = double(std::abs(answer.t));
  return !answer.hit || t == 0 || (t > kLeast && t < kLargest);
}

/// x as a float, if it is one.
bool to_exact_float(double x, float& out) {
  out = float(x);
  return double(out) == x && (x == 0 || std::isinf(x) || std::isnormal(out));
}
bool to_exact_float(const Vec3d& v, Vec3f& out) {
  return to_exact_float(v.x, out.x) && to_exact_float(v.y, out.y) && to_exact_float(v.z, out.z);
}

/// The ray with other numbers, where floats hold them.
std::optional<Rayf> exact_ray(const Vec3d& origin, const Vec3d& direction, double t_min, double t_max) {
  Rayf ray;
  const bool exact = to_exact_float(origin, ray.origin) && to_exact_float(direction, ray.direction) &&
                     to_exact_float(t_min, ray.t_min) && to_exact_float(t_max, ray.t_max);
  return exact && in_domain(ray) ? std::optional(ray) : std::nullopt;
}

/// Whether a + b is a double.
bool adds_exactly(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return (a - (sum - of_b)) + (b - of_b) == 0;
}
bool adds_exactly(const Vec3d& a, const Vec3d& b) {
  return adds_exactly(a.x, b.x) && adds_exactly(a.y, b.y) && adds_exactly(a.z, b.z);
}

Vec3d renamed(const Vec3d& v) { return {v.z, v.x, v.y}; }

Affine3d scaled(const Affine3d& m, double factor) {
  return {m.x * factor, m.y * factor, m.z * factor, m.origin * factor};
}

/// A power of two other than 1.
double random_power(Random& random) { return std::exp2(random.integer(1, 12) * (random.coin() ? 1 : -1)); }

/// Minus the largest power of two in x, which x can lose without rounding.
double leading_power(float x) { return x == 0 ? 0 : -std::copysign(std::exp2(std::ilogb(x)), double(x)); }

std::optional<Surface> reversed(const Polygon& polygon) {
  auto loops = loops_of(polygon);
  for (auto& loop : loops) std::reverse(loop.begin(), loop.end());
  try {
    return make_polygon(loops);
  } catch (const PolygonError&) {
    return std::nullopt;  // loops that meet in a repeated vertex
  }
}
std::optional<Surface> reversed(const Triangle& t) { return Triangle{t.a, t.c, t.b}; }
template <class S>
std::optional<Surface> reversed(const S&) {
  return std::nullopt;
}

std::optional<Surface> alone_in_composite(const Surface& surface) {
  const auto composite = [](const ClosedBody& body) -> std::optional<Surface> {
    const CompositeOperand operand{body, {}};
    return make_composite(CompositeNode::Operation::unite, {&operand, 1});
  };
  if (const auto* sphere = std::get_if<Sphere>(&surface)) return composite(*sphere);
  if (const auto* box = std::get_if<Box>(&surface)) return composite(*box);
  if (const auto* cylinder = std::get_if<Cylinder>(&surface); cylinder && cylinder->caps) return composite(*cylinder);
  if (const auto* quadric = std::get_if<Quadric>(&surface); quadric && quadric->solid) return composite(*quadric);
  return std::nullopt;
}

class Relations {
 public:
  Relations(const Subject& subject, std::span<const Rayf> rays, std::span<const Answer> answers, uint64_t first,
            Random& random)
      : subject_(subject), rays_(rays), answers_(answers), first_(first), random_(random) {}

  RelationCounts check() {
    check_scaled();
    check_renamed();
    check_moved();
    check_split();
    check_shadow();
    if (const auto composite = alone_in_composite(subject_.surface))
      ask_same_rays(*composite, Relation::identity_instance, 1);
    if (const auto surface = std::visit([](const auto& s) { return reversed(s); }, subject_.surface))
      ask_same_rays(*surface, Relation::reversed_vertices, 0);
    return counts_;
  }

 private:
  struct Question {
    size_t ray;  // the one that it changes
    Rayf asked;
    Answer expected;
  };

  /// Asks the custom intersector of `subject`; `tolerance`: floats by which t may be off.
  void ask(Relation relation, const Subject& subject, std::span<const Question> questions, double tolerance = 0) {
    std::vector<Rayf> rays;
    for (const Question& q : questions) rays.push_back(q.asked);
    std::vector<Answer> answers;
    if (!rays.empty()) custom_party(subject)->answer(rays, answers);
    for (size_t k = 0; k < answers.size(); ++k) {
      const Answer &a = answers[k], &e = questions[k].expected;
      const bool later = e.hit && (!a.hit || a.t > e.t);
      if (relation == Relation::identity_instance && later && is_tie(questions[k].asked)) continue;
      count(relation, questions[k].ray,
            a.hit == e.hit && (!a.hit || (floats_between(a.t, e.t) <= tolerance && a.face == e.face)));
    }
  }
  /// Composites are not met where they are only touched: the ray goes on.
  [[nodiscard]] bool is_tie(const Rayf& ray) const {
    const ExactLine line = exact_line({&subject_.world_from_object, 1}, exact_line(ray));
    return tie_of(subject_.surface, line) != Tie::none;
  }
  void count(Relation relation, size_t ray, bool holds) {
    RelationCount& c = counts_[size_t(relation)];
    ++c.rays;
    if (holds) return;
    if (c.broken++ == 0) c.first_broken = first_ + ray;
  }

  /// Calls change(ray, answer) for each ray in the domain: the changed question, or none.
  template <class Change>
  std::vector<Question> questions(const Change& change) {
    std::vector<Question> list;
    for (size_t k = 0; k < rays_.size(); ++k) {
      if (!in_domain(rays_[k])) continue;
      if (const std::optional<Rayf> asked = change(rays_[k])) list.push_back({k, *asked, answers_[k]});
    }
    return list;
  }

  void ask_same_rays(const Surface& surface, Relation relation, double tolerance) {
    ask(relation, {surface, subject_.world_from_object}, questions([](const Rayf& r) { return std::optional(r); }),
        tolerance);
  }

  void check_scaled() {
    const double factor = random_power(random_);
    const Subject larger{subject_.surface, scaled(subject_.world_from_object, factor)};
    ask(Relation::scaled_space, larger, questions([&](const Rayf& r) {
          return exact_ray(Vec3d(r.origin) * factor, Vec3d(r.direction) * factor, r.t_min, r.t_max);
        }));
    auto list = questions([&](const Rayf& r) {
      return exact_ray(Vec3d(r.origin), Vec3d(r.direction) * factor, r.t_min / factor, r.t_max / factor);
    });
    std::erase_if(list, [](const Question& q) { return !scales(q.expected); });
    for (Question& q : list) q.expected.t = float(q.expected.t / factor);
    ask(Relation::scaled_direction, subject_, list);
  }

  void check_renamed() {
    const Affine3d& m = subject_.world_from_object;
    const Subject turned{subject_.surface, {renamed(m.x), renamed(m.y), renamed(m.z), renamed(m.origin)}};
    ask(Relation::permuted_axes, turned, questions([](const Rayf& r) {
          return exact_ray(renamed(Vec3d(r.origin)), renamed(Vec3d(r.direction)), r.t_min, r.t_max);
        }),
        1);
  }

  /// By what leaves one ray's origin smaller, and therefore exact.
  void check_moved() {
    const Vec3f& o = rays_[random_.bits() % rays_.size()].origin;
    if (!is_finite(o)) return;
    const Vec3d by{leading_power(o.x), leading_power(o.y), leading_power(o.z)};
    Subject there = subject_;
    if (!adds_exactly(there.world_from_object.origin, by)) return;
    there.world_from_object.origin += by;
    ask(Relation::moved, there, questions([&](const Rayf& r) -> std::optional<Rayf> {
          if (!adds_exactly(Vec3d(r.origin), by)) return std::nullopt;
          return exact_ray(Vec3d(r.origin) + by, Vec3d(r.direction), r.t_min, r.t_max);
        }),
        1);
  }

  /// At the hit itself, a float beside it, or anywhere.
  [[nodiscard]] float random_cut(const Answer& answer) {
    if (answer.hit && random_.coin()) return moved_by_floats(answer.t, random_.integer(-1, 1));
    return float((answer.hit ? double(answer.t) : 1.0) * random_.uniform(0, 2));
  }

  void check_split() {
    std::vector<Question> list;
    for (size_t k = 0; k < rays_.size(); ++k) {
      const Answer& whole = answers_[k];
      const float cut = random_cut(whole);
      if (!in_domain(rays_[k]) || !(cut > rays_[k].t_min && cut < rays_[k].t_max)) continue;
      Rayf before = rays_[k], after = rays_[k];
      before.t_max = after.t_min = cut;
      list.push_back({k, before, whole.hit && whole.t <= cut ? whole : Answer{}});
      if (!whole.hit || whole.t >= cut) list.push_back({k, after, whole});
    }
    ask(Relation::split_range, subject_, list);
  }

  void check_shadow() {
    std::vector<Rayf> rays;
    std::vector<size_t> numbers;
    for (size_t k = 0; k < rays_.size(); ++k)
      if (in_domain(rays_[k])) rays.push_back(rays_[k]), numbers.push_back(k);
    std::vector<bool> blocked;
    if (rays.empty() || !custom_party(subject_)->answer_shadows(rays, blocked)) return;
    for (size_t k = 0; k < rays.size(); ++k)
      count(Relation::shadow, numbers[k], blocked[k] == answers_[numbers[k]].hit);
  }

  const Subject& subject_;
  std::span<const Rayf> rays_;
  std::span<const Answer> answers_;
  uint64_t first_;
  Random& random_;
  RelationCounts counts_;
};

}  // namespace

const char* name_of(Relation relation) {
  constexpr const char* names[kRelations] = {
      "scaled space", "scaled direction", "permuted axes",     "moved",
      "split range",  "shadow",           "identity instance", "reversed vertices"};
  return names[size_t(relation)];
}

void RelationCount::add(const RelationCount& later) {
  rays += later.rays, broken += later.broken;
  if (!first_broken) first_broken = later.first_broken;
}

RelationCounts check_relations(const Subject& subject, std::span<const Rayf> rays, std::span<const Answer> answers,
                               uint64_t first, Random random) {
  return Relations(subject, rays, answers, first, random).check();
}

}  // namespace alhazen::crosscheck
