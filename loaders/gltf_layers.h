// The KHR_materials_* extensions that add layers and lobes to glTF's own material.
#pragma once

#include <optional>

#include "loaders/json_check.h"
#include "materials/material.h"

namespace alhazen {

/// The textureInfo `key` of `owner`, with KHR_texture_transform; unused where there is none.
[[nodiscard]] TextureUse texture_use(const JsonRef& owner, const char* key);

using TextureReader = std::function<TextureUse(const JsonRef& owner, const char* key)>;

/// Clearcoat, sheen, anisotropy, iridescence, diffuse transmission, volume and dispersion of a material.
void read_layers(const JsonRef& material, const TextureReader& texture_use, Material& m);

/// The UV set along which the material wants tangents; none where it has no use for them.
[[nodiscard]] std::optional<uint32_t> tangent_uv_set(const Material& material);

/// What their JSON may say, for the `extensions` of a material; `texture_info` makes the check of a textureInfo with
/// properties of its own.
[[nodiscard]] std::vector<Property> layer_properties(const std::function<Check(std::vector<Property>)>& texture_info);

}  // namespace alhazen
