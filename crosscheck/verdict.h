// Who is right: the answers of both parties against the judge's.
#pragma once

#include "crosscheck/judge.h"
#include "crosscheck/party.h"

namespace alhazen::crosscheck {

enum class Verdict : uint8_t {
  agree,       // nobody is wrong
  a_right,     // Embree's native geometry is wrong
  b_right,     // the custom intersector is wrong
  both_wrong,  // both are, or the custom one where there is no other
  tie_edge,    // ties: the custom one keeps its convention
  tie_tangent,
  tie_coplanar,
  out_of_domain,  // no direction, not finite, or further than traversal can hold
  unexplained,    // the judge's two instances disagree
};
inline constexpr int kVerdicts = 9;
[[nodiscard]] const char* name_of(Verdict verdict);
[[nodiscard]] constexpr bool is_failure(Verdict v) {
  return v == Verdict::b_right || v == Verdict::both_wrong || v == Verdict::unexplained;
}

enum class Fault : uint8_t {
  none,
  false_miss,
  false_hit,
  wrong_t,
  wrong_face,
  wrong_side,
  wrong_normal,
  wrong_surface
};
inline constexpr int kFaults = 8;
[[nodiscard]] const char* name_of(Fault fault);

/// By how many floats `t` is off. 0 where it is correctly rounded.
[[nodiscard]] double floats_between(float t, float exact_t);

/// The first thing that is wrong with an answer, in the order of `Fault`. `t_tolerance`: in floats.
[[nodiscard]] Fault fault_of(const Answer& answer, const Judgement& truth, double t_tolerance);

/// `b`: none where there is no such party, or it was not asked.
[[nodiscard]] Verdict verdict_of(Fault a, std::optional<Fault> b, const Judgement& truth);

/// Whether intersectors are answerable for such a ray.
[[nodiscard]] bool in_domain(const Rayf& ray);

}  // namespace alhazen::crosscheck
