// `alhazen make` and `alhazen convert`: benchmark scenes, well known or from .nff files, as .glb.
#pragma once

#include "apps/command.h"

namespace alhazen {

[[nodiscard]] Command add_make_command(CLI::App& program);
[[nodiscard]] Command add_convert_command(CLI::App& program);

}  // namespace alhazen
