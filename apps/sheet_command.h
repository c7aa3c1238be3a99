// `alhazen sheet FOLDER`: every model below a folder on one labelled page.
#pragma once

#include "apps/command.h"

namespace alhazen {

[[nodiscard]] Command add_sheet_command(CLI::App& program);

}  // namespace alhazen
