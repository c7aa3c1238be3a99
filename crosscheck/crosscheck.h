// Three parties for each ray: A, the custom intersector; B, Embree's nearest native geometry; J, the exact judge.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "crosscheck/check_intersector.h"
#include "crosscheck/population.h"
#include "crosscheck/relations.h"
#include "crosscheck/textbook_triangles.h"
#include "crosscheck/verdict.h"

namespace alhazen::crosscheck {

struct Options {
  uint64_t rays = 10000;  // of one family and population
  uint64_t seed = 1;
  std::optional<uint64_t> only = {};         // the number of the one ray to judge
  double t_tolerance_a = 1;                  // in floats
  double t_tolerance_b = 16;                 // as many as Embree's own tests allow
  const Intersector* intersector = nullptr;  // in the place of A
};

/// One ray and what was said of it.
struct Case {
  Population population;
  uint64_t index;
  const Subject* subject;  // null: a scene's ray that nobody says hits anything, or on which all agree
  Rayf ray;
  Answer a;
  std::optional<Answer> b;
  Judgement truth;
  std::optional<Judgement> b_truth;  // of the surface in floats, where that is another one
  Fault a_fault = Fault::none;
  std::optional<Fault> b_fault;
  Verdict verdict;
  bool robust_native = false;  // the flag of B's scene
  // Scenes, in words: what each party hits. Filled where they disagree or one ray is asked about.
  std::string a_surface = {}, b_surface = {}, true_surface = {};
  uint32_t object = kNone;  // scenes: what is truly hit
  double facing = 0;        // scenes: how squarely, the cosine to its normal
};

/// What B is measured by.
[[nodiscard]] inline const Judgement& truth_for_b(const Case& c) { return c.b_truth ? *c.b_truth : c.truth; }

/// Counts for one family and population.
struct Tally {
  uint64_t rays = 0, hits = 0, b_asked = 0;
  std::array<uint64_t, kVerdicts> verdicts{};
  std::array<uint64_t, kFaults> a_faults{}, b_faults{};
  uint64_t a_judged = 0, a_exact = 0, b_judged = 0, b_exact = 0;  // hits in common with the judge; t correctly rounded
  double a_worst = 0, b_worst = 0;                                // floats
  RelationCounts relations{};                                     // A asked in other ways
  TextbookCounts textbook{};                                      // triangles alone
  uint64_t a_quads = 0, a_rationals = 0, judge_rationals = 0;

  [[nodiscard]] uint64_t of(Verdict v) const { return verdicts[size_t(v)]; }
  [[nodiscard]] uint64_t failures() const;
  void add(const Tally& other);
};

/// Adds one case to what is counted of it alone: everything but `a_quads`, `a_rationals` and `textbook`.
void count(const Case& c, Tally& tally);

/// What becomes of a run while it goes on, all called from one thread in the order of the rays.
struct Observer {
  std::function<void(const Case&)> judged;            // every ray
  std::function<bool()> stop = [] { return false; };  // asked now and then
};

/// Rays of one family and population. The same arguments give the same cases in the same order, whatever the threads.
[[nodiscard]] Tally check(const Family& family, Population population, const Options& options,
                          const Observer& observer);

}  // namespace alhazen::crosscheck
