// `alhazen info`: what a scene file holds.
#pragma once

#include "apps/command.h"

namespace alhazen {

[[nodiscard]] Command add_info_command(CLI::App& program);

}  // namespace alhazen
