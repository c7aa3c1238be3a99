#include "crosscheck/verdict.h"

#include <bit>
#include <cmath>

namespace alhazen::crosscheck {
namespace {

constexpr float kLargestCoordinate = 1.8e18f;  // just within Embree's limit
constexpr double kUnclearNormal = 0.1;         // radians: what turns so much with t is not judged

/// Floats in their order, as consecutive integers.
int64_t ordinal(float x) {
  const auto bits = std::bit_cast<int32_t>(x);
  return bits >= 0 ? bits : -int64_t(bits & 0x7FFFFFFF);
}

}  // namespace

const char* name_of(Verdict verdict) {
  constexpr const char* names[kVerdicts] = {"AGREE",       "A_RIGHT",      "B_RIGHT",       "BOTH_WRONG", "TIE_EDGE",
                                            "TIE_TANGENT", "TIE_COPLANAR", "OUT_OF_DOMAIN", "UNEXPLAINED"};
  return names[size_t(verdict)];
}

const char* name_of(Fault fault) {
  constexpr const char* names[kFaults] = {"none",       "false miss", "false hit",    "wrong t",
                                          "wrong face", "wrong side", "wrong normal", "wrong surface"};
  return names[size_t(fault)];
}

double floats_between(float t, float exact_t) {
  if (std::isnan(t) || std::isnan(exact_t)) return HUGE_VAL;
  return double(std::abs(ordinal(t) - ordinal(exact_t)));
}

Fault fault_of(const Answer& answer, const Judgement& truth, double t_tolerance) {
  if (answer.hit != truth.hit) return answer.hit ? Fault::false_hit : Fault::false_miss;
  if (!truth.hit) return Fault::none;
  if (!(floats_between(answer.t, truth.t) <= t_tolerance)) return Fault::wrong_t;
  if (answer.face != kNoFace && answer.face != truth.face) return Fault::wrong_face;
  const bool says_normal = dot(answer.normal_object, answer.normal_object) > 0;
  const bool has_normal = dot(truth.normal_object, truth.normal_object) > 0;
  if (!says_normal || !has_normal || truth.normal_tolerance > kUnclearNormal) return Fault::none;
  if (dot(answer.normal_object, truth.normal_object) < 0) return Fault::wrong_side;
  const double off = length(answer.normal_object - truth.normal_object);
  return off <= truth.normal_tolerance ? Fault::none : Fault::wrong_normal;
}

Verdict verdict_of(Fault a, std::optional<Fault> b, const Judgement& truth) {
  const bool a_right = a == Fault::none, b_right = b == Fault::none;
  if (!a_right) return b && b_right ? Verdict::b_right : Verdict::both_wrong;
  switch (truth.tie) {
    case Tie::edge:
      return Verdict::tie_edge;
    case Tie::tangent:
      return Verdict::tie_tangent;
    case Tie::coplanar:
      return Verdict::tie_coplanar;
    default:
      return b && !b_right ? Verdict::a_right : Verdict::agree;
  }
}

bool in_domain(const Rayf& ray) {
  const auto reachable = [](const Vec3f& v) { return is_finite(v) && max_component(abs(v)) < kLargestCoordinate; };
  const bool has_range = ray.t_min >= 0 && ray.t_min != ray.t_max;
  return reachable(ray.origin) && reachable(ray.direction) && ray.direction != Vec3f{} && has_range;
}

}  // namespace alhazen::crosscheck
