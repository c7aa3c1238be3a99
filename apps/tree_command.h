// `alhazen tree`: the rays that a pixel is made of.
#pragma once

#include "apps/command.h"

namespace alhazen {

[[nodiscard]] Command add_tree_command(CLI::App& program);

}  // namespace alhazen
