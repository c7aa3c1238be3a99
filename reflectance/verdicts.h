// What a check found, in words.
#pragma once

#include <string>
#include <vector>

#include "reflectance/check_brdf.h"

namespace alhazen {

struct Verdict {
  std::string law;  // "energy", "reciprocity", "positivity"
  bool kept;
  std::string finding;  // with figures: "up to 2.31 times what comes in is reflected (at 85°)"
};

[[nodiscard]] std::vector<Verdict> verdicts(const Subject& subject, const BrdfCheck& check);

/// One sentence: whether a real surface could scatter so.
[[nodiscard]] std::string summary(const BrdfCheck& check);

/// "0.318", "1090": three significant digits, without an exponent where there is no need.
[[nodiscard]] std::string plain_number(double v);

/// A line for each law, then the summary.
[[nodiscard]] std::string laws_text(const Subject& subject, const BrdfCheck& check);

}  // namespace alhazen
