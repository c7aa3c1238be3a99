// glTF materials, with their KHR and ALHAZEN extensions.
#pragma once

#include <vector>

#include "loaders/gltf_source.h"

namespace alhazen {

/// A texture to be made: roughness = 1 - factor x alpha of another.
struct RoughnessTexture {
  uint32_t glossiness_texture;
  float factor;
};

struct GltfMaterials {
  std::vector<Material> materials;          // the file's, then glTF's default one
  std::vector<char> uses_texture;           // for each of the file's textures, whether a material does
  std::vector<RoughnessTexture> roughness;  // used under the numbers that follow those of the file's textures
  std::vector<JsonRef> measured;            // URIs of ALHAZEN_materials_measured, each once: by MeasuredUse::brdf
};

[[nodiscard]] GltfMaterials read_materials(const GltfSource& source);

}  // namespace alhazen
