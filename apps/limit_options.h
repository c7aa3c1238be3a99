// The options that say how much a scene may ask for.
#pragma once

#include <CLI/CLI.hpp>

#include "loaders/load_limits.h"

namespace alhazen {

/// --max-memory and the others. `limits`, which must live as long as `command`, holds the defaults.
void add_limit_options(CLI::App& command, LoadLimits& limits);

}  // namespace alhazen
