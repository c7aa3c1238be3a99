// Newell's teapot: 32 bicubic Bezier patches.
#pragma once

#include "procedural/nff.h"

namespace alhazen {

/// Adds it with z up, its bottom in the plane z = 0, as `size` x `size` pairs of triangles with normals a patch.
void add_teapot(NffScene& scene, uint32_t material, int size);

}  // namespace alhazen
