// `alhazen signature`: which object each pixel shows.
#pragma once

#include "apps/command.h"

namespace alhazen {

[[nodiscard]] Command add_signature_command(CLI::App& program);

}  // namespace alhazen
