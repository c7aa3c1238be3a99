#include "renderer/shading_groups.h"

#include <algorithm>
#include <map>

#include "renderer/media.h"

namespace alhazen {
namespace {

/// Materials whose shading is a straight line: what layers and bodies add is shaded one by one.
bool allows_lanes(const Material& m) {
  if (bounds_body(m)) return false;
  switch (m.model) {
    case ShadingModel::phong:
    case ShadingModel::unlit:
      return true;
    case ShadingModel::metallic_roughness:
      return !(m.clearcoat.factor > 0 || max_component(m.sheen.color) > 0 || m.anisotropy.strength > 0 ||
               m.iridescence.factor > 0 || m.diffuse_transmission.factor > 0 || m.transmission > 0);
    case ShadingModel::measured:
      return false;
  }
  return false;
}

bool has_textures(const Material& m) {
  const auto uses = texture_uses(m);
  return std::any_of(uses.begin(), uses.end(), [](const TextureUse* use) { return bool(*use); });
}

}  // namespace

std::array<const TextureUse*, 8> texture_uses(const Material& m) {
  static const TextureUse none;
  const TextureUse* const alpha = m.alpha_mode == AlphaMode::blend ? &m.base_color_texture : &none;
  if (m.model == ShadingModel::unlit)
    return {&m.normal_texture, &m.base_color_texture, &none, &none, &none, &none, &none, &none};
  if (m.model == ShadingModel::phong)
    return {
        alpha, &m.normal_texture, &m.emissive_texture, &m.phong.ambient_texture, &m.phong.diffuse_texture, &none, &none,
        &none};
  return {&m.normal_texture,         &m.emissive_texture,   &m.metallic_roughness_texture, &m.specular_texture,
          &m.specular_color_texture, &m.base_color_texture, &m.transmission_texture,       &m.occlusion_texture};
}

ShadingGroups::ShadingGroups(const Scene& scene) {
  std::map<ShadingGroup, uint32_t> known;
  const auto group_of = [&](uint32_t material, Attributes has, bool on_shapes) {
    const Material& m = scene.materials[material];
    const bool textures = has_textures(m);
    // Where Phong's, which know no mipmaps, are not meant, shapes are measured one by one for their textures.
    if (!allows_lanes(m) || (on_shapes && textures && m.model != ShadingModel::phong)) return uint32_t{0};
    if (!textures) has.uv_sets = 0;
    if (!m.normal_texture) has.tangents = false;
    const ShadingGroup group{material, true, textures, on_shapes, has};
    const auto [place, is_new] = known.try_emplace(group, uint32_t(groups_.size()));
    if (is_new) groups_.push_back(group);
    return place->second;
  };
  for (const Mesh& mesh : scene.geometry.meshes) {
    first_part_.push_back(uint32_t(group_of_part_.size()));
    for (const TriangleMesh& part : mesh.parts)
      group_of_part_.push_back(group_of(part.material, attributes(part), false));
  }
  for (const ShapeInstance& shape : scene.geometry.shape_instances)
    group_of_shape_.push_back(group_of(shape.material, {}, true));
}

}  // namespace alhazen
