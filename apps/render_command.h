// `alhazen render`: from a scene file to a picture file.
#pragma once

#include "apps/command.h"

namespace alhazen {

[[nodiscard]] Command add_render_command(CLI::App& program);

}  // namespace alhazen
