// `alhazen brdf`: how a material scatters.
#pragma once

#include "apps/command.h"

namespace alhazen {

[[nodiscard]] Command add_brdf_command(CLI::App& program);

}  // namespace alhazen
