#include "crosscheck/subject_check.h"

#include <cmath>

#include "accel/shape_hits.h"
#include "crosscheck/native_subject.h"

namespace alhazen::crosscheck {

SubjectCheck::SubjectCheck(const Subject& subject, bool robust_native, const Options& options)
    : subject_(subject), options_(options), robust_native_(robust_native), judge_(subject) {}

/// Rays out of the domain are not asked about: Debian's Embree ends the program on some of them.
void SubjectCheck::ask(std::vector<Rayf> rays, Tally& tally) {
  rays_ = rays;
  for (Rayf& ray : rays)
    if (!in_domain(ray)) ray = Rayf{{0, 0, 0}, {0, 0, 1}};
  const DoubtCounts before = doubt_counts();
  (options_.intersector ? plugin_party(*options_.intersector) : custom_party(subject_))->answer(rays, a_);
  const DoubtCounts after = doubt_counts();
  tally.a_quads += after.quad - before.quad, tally.a_rationals += after.exact - before.exact;
  const auto native = native_subject(subject_);
  if (!native) return;
  if (const auto party = native_party(native->subject, robust_native_)) party->answer(rays, b_);
  if (native->rounded) native_judge_ = std::make_unique<Judge>(native->subject);
}

Case SubjectCheck::judged(size_t k, Population population, uint64_t number) const {
  Case c{.population = population,
         .index = number,
         .subject = &subject_,
         .ray = rays_[k],
         .a = a_[k],
         .b = {},
         .truth = {},
         .b_truth = {},
         .b_fault = {},
         .verdict = Verdict::out_of_domain,
         .robust_native = robust_native_};
  if (!b_.empty() && b_[k].asked) c.b = b_[k];
  if (in_domain(c.ray)) decide(c);
  return c;
}

void SubjectCheck::decide(Case& c) const {
  c.truth = judge_.closest(c.ray);
  if (c.truth.hit && !std::isfinite(c.truth.t)) return;  // further than floats reach
  c.a_fault = fault_of(c.a, c.truth, options_.t_tolerance_a);
  if (c.b && native_judge_) c.b_truth = native_judge_->closest(c.ray);
  if (c.b) c.b_fault = fault_of(*c.b, truth_for_b(c), options_.t_tolerance_b);
  c.verdict = verdict_of(c.a_fault, c.b_fault, c.truth);
  if (c.index % kSecondInstance == 0 && !same_answer(c.truth, judge_.closest_exactly(c.ray)))
    c.verdict = Verdict::unexplained;
}

Case judge_alone(const Subject& subject, const Rayf& ray, bool robust_native, const Options& options) {
  SubjectCheck check(subject, robust_native, options);
  Tally unused;
  check.ask({ray}, unused);
  return check.judged(0, Population::uniform, 0);
}

}  // namespace alhazen::crosscheck
