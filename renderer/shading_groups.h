// Which hits are shaded side by side: those on one material, in lanes where the material allows.
#pragma once

#include <array>
#include <compare>
#include <vector>

#include "renderer/surface.h"

namespace alhazen {

struct ShadingGroup {
  uint32_t material = 0;
  bool in_lanes = false;  // else one by one
  bool has_textures = false;
  bool on_shapes = false;
  Attributes attributes;  // what the material needs of its meshes

  friend auto operator<=>(const ShadingGroup&, const ShadingGroup&) = default;
};

/// The textures that shading in lanes looks up, in its order; at the end perhaps some that are none.
[[nodiscard]] std::array<const TextureUse*, 8> texture_uses(const Material& material);

/// The groups of a scene; group 0 are the hits that are shaded one by one.
class ShadingGroups {
 public:
  explicit ShadingGroups(const Scene& scene);

  [[nodiscard]] size_t size() const { return groups_.size(); }
  [[nodiscard]] const ShadingGroup& operator[](size_t group) const { return groups_[group]; }
  [[nodiscard]] uint32_t of(const Geometry& geometry, uint32_t object, uint32_t part) const {
    return is_shape(geometry, object) ? group_of_shape_[object - geometry.mesh_instances.size()]
                                      : group_of_part_[first_part_[geometry.mesh_instances.mesh_of(object)] + part];
  }

 private:
  std::vector<ShadingGroup> groups_{ShadingGroup{}};
  std::vector<uint32_t> first_part_, group_of_part_;  // by mesh; by part, mesh after mesh
  std::vector<uint32_t> group_of_shape_;              // by shape instance
};

}  // namespace alhazen
