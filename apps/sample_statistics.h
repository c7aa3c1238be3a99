// What a few repeated measurements say.
#pragma once

#include <vector>

namespace alhazen {

/// The middle one, or the mean of the two in the middle. Of at least one.
[[nodiscard]] double median(std::vector<double> samples);

/// Half of the 25th to 75th percentile's distance over the median: 0 where all are the same.
[[nodiscard]] double relative_spread(std::vector<double> samples);

/// How probable it is that two sets of samples of the same thing differ in rank as much as these or more, either way:
/// the two-sided Mann-Whitney test, exact while there are no ties and no more than 40 samples together, else by the
/// normal approximation with its corrections for ties and continuity.
/// source  H. B. Mann, D. R. Whitney, "On a Test of Whether one of Two Random Variables is Stochastically Larger than
///         the Other", Annals of Mathematical Statistics 18(1), 1947.
[[nodiscard]] double mann_whitney(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace alhazen
