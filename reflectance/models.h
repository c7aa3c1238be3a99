// Models by name, so that they can be looked at and compared without a scene.
#pragma once

#include <string>
#include <vector>

#include "reflectance/subject.h"

namespace alhazen {

/// What a model may be given; each takes those of its row in `reflectance_models`.
struct ModelSettings {
  Rgb diffuse{0.5f}, specular{0.3f};
  float shininess = 32;
  float roughness = 0.3f;  // perceptual, as glTF's: alpha is its square
  float metallic = 0, anisotropy = 0;
  float ior = 1.5f;
};

struct ReflectanceModel {
  const char* name;
  const char* description;
  std::vector<const char*> settings;  // names of the fields of ModelSettings that it takes
  Subject (*subject)(const ModelSettings&);
};

/// lambert, phong, normalised-phong, ggx, gltf, dielectric.
[[nodiscard]] const std::vector<ReflectanceModel>& reflectance_models();

}  // namespace alhazen
