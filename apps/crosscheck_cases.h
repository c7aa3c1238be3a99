// `alhazen crosscheck --case`: cases from files, judged again.
#pragma once

#include <string>
#include <vector>

#include "crosscheck/crosscheck.h"

namespace alhazen {

/// Judges every case of the files: a JSON object, an array of such, or one a line, as `--json` writes them. Prints a
/// line for each and the record of those that fail, of a case alone always. Returns the number that fail: the custom
/// intersector is wrong, or the judge says something else than is stated. Throws LoadError.
[[nodiscard]] uint64_t judge_cases(const std::vector<std::string>& files, const crosscheck::Options& options);

}  // namespace alhazen
