// What the checks of whole meshes and of spawned rays say.
#pragma once

#include <string>

#include "crosscheck/mesh_check.h"
#include "crosscheck/spawn_check.h"

namespace alhazen::crosscheck {

/// The heads of the columns, then rows under them; a failure's first example on a line of its own.
[[nodiscard]] std::string mesh_head();
[[nodiscard]] std::string mesh_row(const MeshTally& tally);
[[nodiscard]] std::string spawn_head();
[[nodiscard]] std::string spawn_row(const SpawnTally& tally);

}  // namespace alhazen::crosscheck
