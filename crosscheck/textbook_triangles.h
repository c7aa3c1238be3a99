// The two textbook triangle algorithms beside the watertight one: plain double, judged but never counted as failures.
#pragma once

#include <array>

#include "crosscheck/verdict.h"

namespace alhazen::crosscheck {

inline constexpr int kTextbookWays = 2;  // plane and half-spaces, 3x3 system

struct TextbookCount {
  uint64_t rays = 0;
  std::array<uint64_t, kFaults> faults{};
  uint64_t judged = 0, exact = 0;  // hits in common with the judge; t correctly rounded
  double worst = 0;                // floats

  void add(const TextbookCount& other);
};
using TextbookCounts = std::array<TextbookCount, kTextbookWays>;

/// Asks both about a ray of a triangle. Does nothing for other subjects. `t_tolerance`: in floats.
void count_textbook(const Subject& subject, const Rayf& ray, const Judgement& truth, double t_tolerance,
                    TextbookCounts& counts);

}  // namespace alhazen::crosscheck
