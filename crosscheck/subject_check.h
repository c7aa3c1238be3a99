// One subject and all who judge rays of it: both parties and the judge.
#pragma once

#include <memory>

#include "crosscheck/crosscheck.h"

namespace alhazen::crosscheck {

class SubjectCheck {
 public:
  /// `subject` and `options` must outlive it.
  SubjectCheck(const Subject& subject, bool robust_native, const Options& options);

  [[nodiscard]] const Judge& judge() const { return judge_; }
  /// What A said, ray by ray.
  [[nodiscard]] std::span<const Answer> answers() const { return a_; }

  /// Asks both parties; how often A needed more than doubles is added to the tally.
  void ask(std::vector<Rayf> rays, Tally& tally);

  /// What is to be said of the ray of this place among those asked, `number` being its number in its population.
  [[nodiscard]] Case judged(size_t k, Population population, uint64_t number) const;

 private:
  void decide(Case& c) const;

  const Subject& subject_;
  const Options& options_;
  bool robust_native_;
  Judge judge_;
  std::unique_ptr<Judge> native_judge_;  // where B holds another surface
  std::vector<Rayf> rays_;
  std::vector<Answer> a_, b_;
};

/// A ray that is asked about all alone. `subject` must outlive the case.
[[nodiscard]] Case judge_alone(const Subject& subject, const Rayf& ray, bool robust_native, const Options& options);

}  // namespace alhazen::crosscheck
