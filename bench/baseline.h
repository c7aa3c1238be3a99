// Bare Embree on the same geometry and rays: what ours is compared to. Outside accel/ this is the one place that
// includes Embree, since a baseline that went through our own code would say nothing.
#pragma once

#include "accel/embree.h"
#include "accel/geometry.h"

namespace alhazen {

/// One ray a call, or packets of the native width.
enum class Call : uint8_t { packets, single };

/// Meshes placed by the identity as Embree's triangles, spheres moved but not scaled as its SPHERE_POINTs, everything
/// opaque. `geometry` must outlive it. Terminates where the geometry holds anything else, or Embree reports an error.
class EmbreeBaseline {
 public:
  explicit EmbreeBaseline(const Geometry& geometry, bool robust = true);
  ~EmbreeBaseline();
  EmbreeBaseline(const EmbreeBaseline&) = delete;
  EmbreeBaseline& operator=(const EmbreeBaseline&) = delete;

  /// How many rays of the wave hit anything; and how many segments are blocked.
  size_t intersect(const RayWave& rays_world, Coherence coherence, Call call = Call::packets) const;
  size_t occluded(const RayWave& rays_world, Coherence coherence, Call call = Call::packets) const;

 private:
  RTCDevice device_;
  RTCScene scene_;
  int width_;
};

}  // namespace alhazen
