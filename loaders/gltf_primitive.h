// One primitive of a glTF mesh: its triangles, and what may deform them.
#pragma once

#include "loaders/deform.h"
#include "loaders/gltf_accessor.h"

namespace alhazen {

struct GltfPrimitive {
  JsonRef r;
  TriangleMesh part;      // at rest: still to be deformed and finished
  bool polygons = false;  // FB_ngon_encoding
  std::vector<MorphTarget> targets;
  SkinWeights skin;
};

/// Reads a primitive of triangles, with its morph targets and joints where it is `deformable`; many may be read at the
/// same time. Vertices that no index names are left out where they are many. Throws LoadError for accessors of the
/// wrong shape or length, for vertex indices out of range, for numbers that are not finite and for weights below 0.
[[nodiscard]] GltfPrimitive read_primitive(const GltfBuffers& buffers, const JsonRef& r, bool deformable);

/// What the deformed vertices decide: makes normals unit length, those without a direction the faces'; joins polygons;
/// makes the tangents that the material wants and the file lacks.
void finish(TriangleMesh& part, bool polygons, const Material& material);

/// The part with the room behind its vertices that Embree reads.
[[nodiscard]] TriangleMesh copy_of(const TriangleMesh& part);

/// How many JOINTS_n the primitive has.
[[nodiscard]] size_t joint_sets(const JsonRef& primitive);

}  // namespace alhazen
