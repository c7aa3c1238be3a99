// Those who are asked: the custom intersectors, Embree's native geometries, and intersectors from shared libraries.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "crosscheck/intersector_plugin.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

inline constexpr int kNoFace = -1;

struct Answer {
  bool asked = true;  // false: outside of what the party is for
  bool hit = false;
  float t = 0;
  int face = kNoFace;   // where the party tells faces apart
  Vec3d normal_object;  // unit, or zero where the party does not say
};

class Party {
 public:
  virtual ~Party() = default;
  /// One answer for each ray. Rays are traced in packets of neighbours. Safe from one thread at a time.
  virtual void answer(std::span<const Rayf> rays_world, std::vector<Answer>& answers) = 0;
  /// Whether each ray is blocked, by the party's own shadow query. False where it has none.
  virtual bool answer_shadows(std::span<const Rayf> /*rays_world*/, std::vector<bool>& /*blocked*/) { return false; }
};

/// The custom intersector as traversal calls it: shapes through AcceleratedScene's packets, triangles as a user
/// geometry of their own. The subject must outlive it.
[[nodiscard]] std::unique_ptr<Party> custom_party(const Subject& subject);

/// Embree's nearest native geometry, null where there is none: points for spheres and disks, round linear curves for
/// cylinders and cones with caps (asked with unit directions only), triangles for boxes, convex polygons and triangles.
/// Faces are told for boxes. `robust`: with the scene flag of that name.
[[nodiscard]] std::unique_ptr<Party> native_party(const Subject& subject, bool robust);

/// A user geometry that answers by the intersector, which must outlive it.
[[nodiscard]] std::unique_ptr<Party> plugin_party(const alhazen_intersector& intersector);

/// "3.13.5, 16 lanes": Embree's version and the width of its packets here.
[[nodiscard]] std::string embree_version();

}  // namespace alhazen::crosscheck
