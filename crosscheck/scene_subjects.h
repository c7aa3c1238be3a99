// The shapes and triangles of a scene as subjects.
#pragma once

#include <span>

#include "accel/geometry.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

/// Families of what the scene places, each surface under the map of its node; triangles as the renderer traverses them.
/// `geometry` must outlive them.
///
/// wanted    "all": a family for each kind of surface there is (sphere, cylinder, disk, box, polygon, quadric,
///           composite, triangle); one of these; or one family of a node by its name or number, of its shapes if it has
///           any, else of its triangles, or of a mesh's triangles by its name.
/// none      there is nothing of that name.
/// subjects  one for every 64 rays, spread over the scene in a fixed order: each surface once before any comes again.
[[nodiscard]] std::vector<Family> scene_families(const Geometry& geometry, std::span<const std::string> node_names,
                                                 const std::string& wanted);

/// The kinds, and the names of nodes and meshes, that `scene_families` knows.
[[nodiscard]] std::vector<std::string> scene_family_names(const Geometry& geometry,
                                                          std::span<const std::string> node_names);

/// "sphere", "triangle" and so on, by `Surface`'s index.
[[nodiscard]] const char* kind_name(size_t kind);

/// "node 3 'ball'", without control characters.
[[nodiscard]] std::string node_label(std::span<const std::string> node_names, uint32_t node);

/// A triangle of a mesh, in the space of the mesh.
[[nodiscard]] Triangle triangle_of(const TriangleMesh& part, size_t number);

/// Whether traversal can hold it under the map: finite, and not too far.
[[nodiscard]] bool is_reachable(const Triangle& triangle, const Affine3d& world_from_object);

}  // namespace alhazen::crosscheck
