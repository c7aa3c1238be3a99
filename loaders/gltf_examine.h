// What the specification forbids and a picture can do without: found for those who ask what a file holds.
#pragma once

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_source.h"

namespace alhazen {

/// Goes through a file that loads and warns of what breaks the specification, though it is let through: bounds of
/// accessors that are missing or wrong, extensions that are not declared, empty lists, wrong references in what is not
/// used, and such. Reads all of its accessors, and the heads of its images.
void examine_gltf(GltfSource& source, const GltfBuffers& buffers);

}  // namespace alhazen
