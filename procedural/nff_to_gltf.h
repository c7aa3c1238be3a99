// Scenes of the Neutral File Format as glTF.
#pragma once

#include <vector>

#include "procedural/nff.h"

namespace alhazen {

struct GltfForm {
  bool tessellate = false;  // spheres and cones as triangles that any viewer shows; else exact, ALHAZEN_shapes
  int segments = 48;        // around a sphere or cone that is tessellated
};

/// A GLB file. Materials are ALHAZEN_materials_phong (diffuse color x kd, mirror and highlights ks, refraction t), with
/// the nearest metallic-roughness ones for other viewers; lights shine with sqrt(n) / n each, whatever the distance,
/// unless the file gives their colours. A polygon is one face of a polygon mesh. The camera is as the file has it.
[[nodiscard]] std::vector<uint8_t> glb_of(const NffScene& scene, const GltfForm& form);

}  // namespace alhazen
