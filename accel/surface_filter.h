// How traversal asks what it does not know: whether a surface that it meets is there, and how much light it lets
// through.
#pragma once

#include <optional>
#include <span>

#include "core/opacity.h"
#include "core/vec.h"

namespace alhazen {

/// A point where a ray meets a surface.
struct Crossing {
  uint32_t object, part, primitive;  // as in HitWave
  float u, v;                        // triangles: barycentric weights of the second and third vertex
  Vec3d p_object;                    // shapes: the point in the shape's own space
};

/// Plain function pointers with their data, so that accel need not know materials. Both must be safe from any thread.
struct SurfaceFilter {
  std::span<const Opacity> opacity;  // by material index
  const void* data = nullptr;
  bool (*is_present)(const void* data, const Crossing&) noexcept = nullptr;    // false in a hole of a cutout
  Rgb (*transmittance)(const void* data, const Crossing&) noexcept = nullptr;  // share of light passing; 1 in a hole
  // The same of a shape, by its object's number, where it is one for all of its points.
  std::optional<Rgb> (*shape_transmittance)(const void* data, uint32_t object) noexcept = nullptr;
};

}  // namespace alhazen
