// `alhazen crosscheck`: intersectors against Embree's own and an exact judge.
#pragma once

#include "apps/command.h"

namespace alhazen {

/// Some custom intersector was found wrong.
inline constexpr int kIntersectorWrong = 5;

[[nodiscard]] Command add_crosscheck_command(CLI::App& program);

}  // namespace alhazen
