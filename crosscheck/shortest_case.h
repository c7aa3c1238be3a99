// The shortest subject and ray that show what one ray showed.
#pragma once

#include <optional>

#include "crosscheck/crosscheck.h"
#include "crosscheck/stated_case.h"

namespace alhazen::crosscheck {

enum class Blamed : uint8_t { a, b };

/// What was asked, for `stated_case` to read, no more complex than `c` and showing the same fault of the blamed party
/// with the same kind of tie; of B, A being right. The subject stays as it is where the intersector is the user's,
/// which knows no other. None where there is no fault, or the ray does not show it when it is asked about alone.
[[nodiscard]] std::optional<Json> shortest_case(const Case& c, Blamed blamed, const Options& options);

}  // namespace alhazen::crosscheck
