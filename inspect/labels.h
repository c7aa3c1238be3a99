// What people call the parts of a scene: their names, or where they have none, what the file's index calls them.
#pragma once

#include <string>

#include "renderer/scene.h"

namespace alhazen {

/// "lens", or "node 4"; "background" for kNone.
[[nodiscard]] std::string node_label(const Scene& scene, uint32_t node);

/// "glass", or "material 2"; "default" for the material of surfaces that have none, by its index or as kNone.
[[nodiscard]] std::string material_label(const Scene& scene, uint32_t material);

/// "lamp", or "light 0".
[[nodiscard]] std::string light_label(const Scene& scene, uint32_t light);

/// What an object of the geometry is made of: "mesh ring", "mesh 3", "sphere".
[[nodiscard]] std::string object_label(const Geometry& geometry, uint32_t object);

/// "12.3 %" of 0.123.
[[nodiscard]] std::string share_text(double share);

}  // namespace alhazen
