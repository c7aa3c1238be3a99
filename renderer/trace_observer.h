// What Whitted's tracing tells of its rays to whoever asks. Nothing about them changes for it: the same rays, in the
// same packets, to the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "renderer/whitted.h"

namespace alhazen {

/// What light is added to a pixel for, but that of lights.
enum class LightTerm : uint8_t { background, environment, emission, ambient };

/// A hit that is about to be shaded. References live as long as the call.
struct ShadedHit {
  HitIds ids;
  float t;  // in lengths of the ray's direction
  const SurfacePoint& surface;
  Vec3f n;       // shading normal turned towards the ray's origin, unit
  bool enters;   // the ray comes from the side that the surface's normal points to
  float alpha;   // the surface's coverage
  Rgb arriving;  // the ray's weight after what the medium took
};

/// Where light is parted into what is reflected and what passes.
struct Interface {
  Rgb ior_before{1.0f}, ior_after{1.0f};  // indices of refraction for red, green and blue light
  Rgb fresnel{0.0f};                      // share that is reflected
  bool fresnel_counts = false;            // whether the material asks for it
  bool total = false;                     // total internal reflection
};

/// A light's way to a surface, before it is known what stands in it.
struct LightQuery {
  uint32_t light;         // index into Scene::lights
  const Rayf& shadow;     // towards the light
  float distance;         // metres; infinite for directional lights
  Rgb arriving;           // colour x intensity x attenuation at the surface
  Rgb weight;             // of the surface in the sample
  Rgb diffuse, specular;  // what the surface makes of it towards the ray's origin; layers count as specular
};

enum class SpawnOutcome : uint8_t { traced, depth_limit, weight_limit };

/// Called by one thread, for one cell at a time.
class TraceObserver {
 public:
  virtual ~TraceObserver() = default;

  /// The camera rays of a sample are pending; `times` as WaveArena::time_of_pixel.
  virtual void begin_sample(int sample, const PathWave& camera_rays, const Lanes<float>& times) = 0;
  /// The pending rays from `first` on become the wave: its ray i is the pending one first + i.
  virtual void take_wave(size_t first) = 0;

  /// What follows is said of ray i of the wave, until the next. Rays come in the order in which they are shaded.
  virtual void look_at(size_t i) = 0;
  virtual void hit(const ShadedHit& hit) = 0;
  /// The surface lies within a body of higher priority: the ray goes straight on.
  virtual void pass_unnoticed() = 0;
  virtual void part(const Interface& interface) = 0;
  /// This is added to the pixel now.
  virtual void add(LightTerm term, const Rgb& light) = 0;
  /// The ray sees the background, which is left out of a transparent picture: so much of the pixel is not covered.
  virtual void uncover(float share) = 0;
  /// A branch goes on from the hit. Those that are traced become the last ones pending when the wave is shaded, first
  /// those of the first bounce, in the order of their spawning, then those of the next.
  virtual void spawn(const Rayf& ray, const Path& path, Bounce bounce, SpawnOutcome outcome) = 0;

  /// A shadow ray is queued.
  virtual void ask(const LightQuery& query) = 0;
  /// `light` is added to the pixel of the i-th of those queued since the last `answered`: all that arrives of it.
  virtual void answer(size_t i, const Rgb& visible, const Rgb& light) = 0;
  virtual void answered() = 0;
};

/// What an observer knows of each ray, from its spawning until its wave is shaded.
template <class T>
class FollowedRays {
 public:
  void begin(size_t camera_rays, const T& value) { pending_.assign(camera_rays, value); }
  void spawn(Bounce bounce, const T& value) { spawned_[size_t(bounce)].push_back(value); }
  void take_wave(size_t first) {
    for (std::vector<T>& spawned : spawned_) {
      pending_.insert(pending_.end(), spawned.begin(), spawned.end());
      spawned.clear();
    }
    current_.assign(pending_.begin() + ptrdiff_t(first), pending_.end());
    pending_.resize(first);
  }
  [[nodiscard]] size_t wave_size() const { return current_.size(); }
  T& pending(size_t i) { return pending_[i]; }
  const T& operator[](size_t i) const { return current_[i]; }

 private:
  std::vector<T> pending_, current_;
  std::array<std::vector<T>, kBounces> spawned_;
};

}  // namespace alhazen
