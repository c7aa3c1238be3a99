// What a scene is made of, as plain data: meshes, analytic shapes, and where they are placed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "accel/mesh_instances.h"
#include "accel/motion.h"
#include "accel/shape.h"
#include "core/transform.h"
#include "core/vec.h"

namespace alhazen {

/// One glTF primitive of triangles, in its mesh's object space (world space once baked, see `bake_single_instances`).
/// Attribute arrays are empty or have one element for each position.
struct TriangleMesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<uint32_t, 3>>
      triangles;                        // indices into positions, all in range; counter-clockwise seen from outside
  std::vector<Vec3f> normals;           // unit length; empty: the polygon's normal
  std::vector<Vec4f> tangents;          // xyz unit length, w the sign of the bitangent cross(n, t) w
  std::vector<std::vector<Vec2f>> uvs;  // TEXCOORD_0, TEXCOORD_1, ...; at most kMaxUvSets
  std::vector<Vec4f> colors;            // COLOR_0, linear RGBA
  uint32_t material = 0;                // always a valid index into Scene::materials
  uint32_t first_primitive = 0;         // index of polygon 0 counted through the whole glTF mesh
  // Polygon meshes: the triangles of a polygon follow each other.
  std::vector<uint32_t> polygon_of_triangle;  // empty: every triangle is a polygon of its own
  std::vector<Vec3f> polygon_normals;         // unit length or 0, by polygon; where there are no normals
};

[[nodiscard]] inline uint32_t polygon_of(const TriangleMesh& part, uint32_t triangle) {
  return part.polygon_of_triangle.empty() ? triangle : part.polygon_of_triangle[triangle];
}
[[nodiscard]] inline size_t polygon_count(const TriangleMesh& part) {
  return part.polygon_of_triangle.empty() ? part.triangles.size() : part.polygon_of_triangle.back() + size_t{1};
}

inline constexpr size_t kMaxUvSets = 8;

/// A glTF mesh: its parts in their order.
struct Mesh {
  std::string name;
  std::vector<TriangleMesh> parts;
};

struct ShapeInstance {
  uint32_t shape = 0;
  uint32_t node = 0;
  uint32_t material = 0;  // always a valid index into Scene::materials
  Affine3d world_from_object;
};

/// Objects are numbered through `mesh_instances`, then `shape_instances`.
struct Geometry {
  std::vector<Mesh> meshes;
  std::vector<Shape> shapes;
  MeshInstances mesh_instances;
  std::vector<ShapeInstance> shape_instances;
  std::vector<uint32_t> parent_of_node;  // by glTF node, kNone for roots; may be shorter: the others are roots
  Motion motion;                         // while the shutter is open; what is above is how it is when it opens
};

/// How often each mesh is placed.
[[nodiscard]] std::vector<uint32_t> uses_of_meshes(const Geometry& geometry);

/// Moves every mesh that is placed exactly once to world space, in place, and makes its instance's map the identity: an
/// instance costs traversal 8 to 28 %, a baked mesh nothing. Normals go by the inverse transpose, tangents by the map;
/// under a mirror the winding is reversed (second and third index swapped) and tangents change handedness, so that
/// outside stays outside. Meshes placed never are emptied.
void bake_single_instances(Geometry& geometry);

/// Visits finite points whose convex hull holds everything placed: the vertices that triangles use, and the corners of
/// the object-space boxes of shapes and of meshes that are placed very often.
void visit_outline(const Geometry& geometry, const std::function<void(const Vec3d& p_world)>& visit);

/// A box around everything placed, in world space, the smallest one around `visit_outline`'s points; empty for no
/// finite geometry.
[[nodiscard]] Bounds3d world_bounds(const Geometry& geometry);

[[nodiscard]] inline bool is_shape(const Geometry& geometry, uint32_t object) {
  return object >= geometry.mesh_instances.size();
}
[[nodiscard]] inline const ShapeInstance& shape_instance(const Geometry& geometry, uint32_t object) {
  return geometry.shape_instances[object - geometry.mesh_instances.size()];
}
/// Of an object that is a mesh's.
[[nodiscard]] inline const TriangleMesh& part_of(const Geometry& geometry, uint32_t object, uint32_t part) {
  return geometry.meshes[geometry.mesh_instances.mesh_of(object)].parts[part];
}
[[nodiscard]] inline uint32_t node_of(const Geometry& geometry, uint32_t object) {
  return is_shape(geometry, object) ? shape_instance(geometry, object).node : geometry.mesh_instances.node_of(object);
}

}  // namespace alhazen
