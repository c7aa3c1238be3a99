#include "reflectance/verdicts.h"

#include <cstdio>

#include "inspect/tree_words.h"

namespace alhazen {
namespace {

/// Four digits, for much happens between 89.9 and 90.
std::string degrees(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g°", v);
  return text;
}

/// What one cannot see of 1 in three digits is no more than 1.
std::string share(double v) {
  char text[32];
  std::snprintf(text, sizeof text, v < 10 ? "%.3f" : "%.3g", v);
  return text;
}

std::string energy_of_beams(const Subject& subject, const BrdfCheck& check) {
  const std::string leaves = subject.smooth ? "is reflected by the lobe or passes" : "is reflected";
  const Finding &most = check.most_beam, &least = check.least_beam;
  if (most.value > 1.002)
    return "from " + degrees(check.gains_from) + " on more than a beam " + leaves + ", up to " + share(most.value) +
           " times (at " + degrees(most.light) + ")";
  return share(least.value) + " (from " + degrees(least.light) + ") to " + share(most.value) + " (from " +
         degrees(most.light) + ") of a beam " + leaves;
}

std::string energy_in_furnace(const BrdfCheck& check) {
  const Finding& most = check.most_furnace;
  const std::string times = share(most.value) + " times as bright as its surroundings";
  return (most.value > 1.002 ? "in a white furnace it shines up to " : "in a white furnace it is at most ") + times +
         " (seen at " + degrees(most.eye) + ")";
}

std::string energy_of_rays(const BrdfCheck& check) {
  return "its rays carry " + share(check.most_rays.value) + " of what comes in at most";
}

Verdict energy(const Subject& subject, const BrdfCheck& check) {
  std::string finding = energy_of_beams(subject, check) + "; " + energy_in_furnace(check);
  if (subject.smooth) finding += "; " + energy_of_rays(check);
  return {"energy", check.keeps_energy(), finding};
}

Verdict reciprocity(const BrdfCheck& check) {
  const Finding& f = check.most_unequal;
  if (check.keeps_reciprocity()) {
    char text[120];
    std::snprintf(text, sizeof text, "light and eye may change places: values differ by %.2g at most, in %zu pairs",
                  f.value, check.pairs);
    return {"reciprocity", true, text};
  }
  return {"reciprocity", false,
          "light and eye may not change places: values differ by up to " + short_number(100 * f.value) + " % (" +
              degrees(f.light) + " and " + degrees(f.eye) + ")"};
}

Verdict positivity(const BrdfCheck& check) {
  if (check.not_finite > 0)
    return {"positivity", false,
            std::to_string(check.not_finite) + " of " + std::to_string(check.pairs) + " values are no numbers"};
  const Finding& f = check.least_value;
  if (check.keeps_positivity()) return {"positivity", true, "finite, and nowhere negative"};
  return {
      "positivity", false,
      "down to " + short_number(f.value) + "/sr (light at " + degrees(f.light) + ", eye at " + degrees(f.eye) + ")"};
}

}  // namespace

std::vector<Verdict> verdicts(const Subject& subject, const BrdfCheck& check) {
  return {energy(subject, check), reciprocity(check), positivity(check)};
}

std::string summary(const BrdfCheck& check) {
  if (check.keeps_all()) return "A physical BRDF, as far as this looks.";
  std::string broken;
  const auto add = [&](bool kept, const char* law) {
    if (!kept) broken += (broken.empty() ? "" : ", ") + std::string(law);
  };
  add(check.keeps_energy(), "energy"), add(check.keeps_reciprocity(), "reciprocity");
  add(check.keeps_positivity(), "positivity");
  return "No physical BRDF: it breaks " + broken + ".";
}

std::string plain_number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, v >= 1000 && v < 1e6 ? "%.0f" : "%.3g", v);
  return text;
}

std::string laws_text(const Subject& subject, const BrdfCheck& check) {
  std::string text;
  for (const Verdict& verdict : verdicts(subject, check))
    text += std::string(verdict.kept ? "kept    " : "broken  ") + verdict.law + ": " + verdict.finding + "\n";
  return text + summary(check) + "\n";
}

}  // namespace alhazen
