// Morph targets and skins: what they make of a mesh's vertices. Pure functions of the numbers that they are given.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/geometry.h"

namespace alhazen {

/// What is added to some vertices; each stands once.
template <class T>
struct Deltas {
  std::vector<uint32_t> vertices;
  std::vector<T> values;
};

struct MorphTarget {
  Deltas<Vec3f> positions, normals, tangents;
  std::vector<Deltas<Vec2f>> uvs;  // by set
  Deltas<Vec4f> colors;
};

/// By which joints each vertex is held.
struct SkinWeights {
  size_t per_vertex = 0;  // 0: by none
  std::vector<uint32_t> joints;
  std::vector<float> weights;  // not negative, their sum over a vertex is 1
};

/// Adds each target's deltas times its weight to the attributes that the part has. Colours are brought back to [0, 1]
/// where targets change them; normals and tangents keep the length that they get.
void morph(TriangleMesh& part, std::span<const MorphTarget> targets, std::span<const double> weights);

/// Moves each vertex by the sum of its joints' maps, weighted: positions by that map, tangents by its linear part, made
/// unit length, normals by the inverse transpose. Where the map mirrors, tangents change handedness, and triangles all
/// of whose corners are mirrored change their winding, so that outside stays outside. Every joint must be within
/// `world_from_rest`.
void skin(TriangleMesh& part, const SkinWeights& weights, std::span<const Affine3d> world_from_rest);

/// The same by one map for all vertices.
void skin(TriangleMesh& part, const Affine3d& world_from_rest);

}  // namespace alhazen
