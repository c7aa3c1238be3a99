// Those who are asked: the custom intersectors, Embree's native geometries, and intersectors from shared libraries.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "crosscheck/check_intersector.h"
#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

inline constexpr int kNoFace = -1;

/// What Embree says besides: for records, not judged.
struct NativeHit {
  Vec3d normal_object;  // unit, or zero where it was not asked for
  bool has_uv = false;  // triangles alone
  float u = 0, v = 0;   // barycentric weights of the second and third vertex
};

struct Answer {
  bool asked = true;  // false: outside of what the party is for
  bool hit = false;
  float t = 0;
  int face = kNoFace;   // where the party tells faces apart
  Vec3d normal_object;  // unit, or zero where the party does not say
  std::optional<NativeHit> native = {};
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

/// The normal where a ray hits, as shading takes it: at the point of the surface nearest to the rounded hit.
[[nodiscard]] Vec3d normal_at_hit(const Shape& shape, const Affine3d& world_from_object, const Rayf& ray_world, float t,
                                  int face);

/// Embree's nearest native geometry, null where there is none: points for spheres and disks, round linear curves for
/// cylinders and cones with caps (asked with unit directions only), triangles for boxes, convex polygons and triangles.
/// Faces are told for boxes. `robust`: with the scene flag of that name. The subject must outlive it.
[[nodiscard]] std::unique_ptr<Party> native_party(const Subject& subject, bool robust);

/// A user geometry that answers by the intersector, which must outlive it.
[[nodiscard]] std::unique_ptr<Party> plugin_party(const Intersector& intersector);

/// What Embree is here.
struct EmbreeFacts {
  std::string version;  // "3.13.5"
  std::string isa;      // "avx512", "avx2", "avx", "sse4.2": the widest that it traverses with; else "other"
  int lanes = 0;        // of its packets
};
[[nodiscard]] const EmbreeFacts& embree_facts();

}  // namespace alhazen::crosscheck
