// A tree of rays as JSON; docs/inspection.md describes it.
#pragma once

#include <string>

#include "inspect/ray_tree.h"

namespace alhazen {

/// Numbers are the shortest decimals that read back as the same floats. `indent` as nlohmann::json::dump takes it.
[[nodiscard]] std::string tree_json(const Scene& scene, const RayTree& tree, int indent);

}  // namespace alhazen
