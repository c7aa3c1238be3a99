// Which of two numbers is the simpler one to read and to reason about.
#pragma once

#include <vector>

namespace alhazen::crosscheck {

/// 0 for 0, then small powers of two, then numbers by the bits of their significand; infinity is as simple as 1.
[[nodiscard]] int complexity(double x);

/// Numbers to try in the place of `x`, all of them simpler, the simplest first: 0, 1 and -1, without the sign, a power
/// of two, rounded to fewer bits either way, nearer to 1 by a power of two. Floats stay floats. `infinity` is among
/// them only for a number that may be it.
[[nodiscard]] std::vector<double> simpler_numbers(double x, bool may_be_infinite);

}  // namespace alhazen::crosscheck
