// `alhazen bench`: what tracing a scene costs.
#pragma once

#include "apps/command.h"

namespace alhazen {

[[nodiscard]] Command add_bench_command(CLI::App& program);

}  // namespace alhazen
