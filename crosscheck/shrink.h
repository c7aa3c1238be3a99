// The shortest document for which something still holds: delta debugging over JSON.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "crosscheck/subject_json.h"

namespace alhazen::crosscheck {

/// Documents get smaller by fewer elements, fewer operands, and simpler numbers (the quoted ones).
[[nodiscard]] uint64_t complexity(const Json& document);

/// Whether a document is still what is looked for. Says no of what makes no sense.
using Holds = std::function<bool(const Json&)>;

/// Other documents to try in the place of one, made by someone who knows what it means.
using Rewrites = std::function<std::vector<Json>(const Json&)>;

/// Calls `visit` with every document that is simpler by one change than `document`, until it says true. Whether it did.
bool for_each_simpler(const Json& document, const Rewrites& rewrites, const Holds& visit);

/// A document that still holds, though none of `for_each_simpler` does; unless `most_tries` were not enough to get
/// there. `document` itself has to hold. The same arguments give the same result.
///
/// source  Zeller and Hildebrandt, Simplifying and Isolating Failure-Inducing Input, IEEE Transactions on Software
///         Engineering 28(2), 2002.
[[nodiscard]] Json shrunk(Json document, const Holds& holds, const Rewrites& rewrites, int most_tries);

}  // namespace alhazen::crosscheck
