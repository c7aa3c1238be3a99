// "did you mean ...?"
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace alhazen {

/// How many insertions, deletions, replacements and swaps of neighbours turn one word into the other, each letter being
/// edited once at most (the optimal string alignment distance).
[[nodiscard]] size_t edit_distance(std::string_view a, std::string_view b);

/// "; did you mean 'render'?", or nothing where no known word is near: more than a third of its letters differ.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

/// "a, b, c"
[[nodiscard]] std::string joined(const std::vector<std::string>& words, const char* separator = ", ");

}  // namespace alhazen
