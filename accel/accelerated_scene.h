// A scene's geometry made ready for ray queries. No name of Embree appears here.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "accel/build_quality.h"
#include "accel/geometry.h"
#include "accel/surface_filter.h"
#include "accel/wave.h"

namespace alhazen {

/// What may be elsewhere, or of another form, when `update` is called; empty lists: nothing. They must outlive the
/// scene.
struct MovingParts {
  std::span<const char> meshes;     // by mesh: itself, or a place of it
  std::span<const char> deforming;  // by mesh: itself
  std::span<const char> nodes;      // by glTF node: its place
};

struct BuildOptions {
  BuildQuality quality = BuildQuality::balanced;
  bool robust = true;    // watertight triangle tests: 13 to 27 % of traversal, and no ray slips between two triangles
  bool compact = false;  // less memory for hierarchies, slower traversal
  int threads = 0;       // for the build; 0: all
  // Triangles of our own in place of Embree's: closed meshes have no leaks, t is rounded once. Several times slower.
  bool watertight = false;
  MovingParts moving{};
};

/// One way to ask Embree about a wave.
struct BareCall {
  bool shadow = false;  // whether something is hit, not what
  int width = 1;        // lanes: 1, 4, 8 or 16
  Coherence coherence = Coherence::incoherent;
};

struct BuiltScene;

/// Immutable but for `update`, so every query is safe from any thread. `geometry` and the filter's data must outlive
/// it: vertices, indices and shapes are read in place.
class AcceleratedScene {
 public:
  /// Builds the hierarchies on the calling thread and TBB's workers. Throws `Error` naming the mesh
  /// or shape that Embree refuses.
  AcceleratedScene(const Geometry& geometry, const SurfaceFilter& filter, const BuildOptions& options = {});
  ~AcceleratedScene();

  /// Takes what moves to where the geometry has it now, with the same bits as if all were built anew, and keeps what is
  /// built of the rest. False, and nothing is done, where objects have come or gone, or surfaces let light through that
  /// did not, or the other way: build anew. `filter` is as the constructor's. Not while rays are traced.
  [[nodiscard]] bool update(const SurfaceFilter& filter);
  AcceleratedScene(const AcceleratedScene&) = delete;
  AcceleratedScene& operator=(const AcceleratedScene&) = delete;

  /// The closest hit of every ray in its [t_min, t_max], surfaces' holes left out. The answers depend on the wave
  /// alone: rays are traced in packets of consecutive lanes, or one by one. Resizes `hits`.
  void intersect(const RayWave& rays_world, Coherence coherence, HitWave& hits) const noexcept;

  /// How much light arrives along every segment [t_min, t_max]: the product of the transmittances of the surfaces
  /// crossed, 1 where there are none, 0 from the first opaque one. Resizes `visible`.
  void transmittance(const RayWave& rays_world, Coherence coherence, Lanes<Rgb>& visible) const noexcept;

  [[nodiscard]] int packet_width() const noexcept;  // lanes traced together: 4, 8 or 16

  /// What Embree holds for it, in bytes, without what it reads in place.
  [[nodiscard]] uint64_t bytes() const noexcept;

  /// Whether such calls answer these rays here: no wider than native, and none that Embree hangs or counts twice in.
  [[nodiscard]] bool allows(const BareCall& call) const noexcept;

  /// Seconds that Embree's calls alone take for the rays: packets are laid out before, answers are left in them.
  [[nodiscard]] double seconds_of(const BareCall& call, const RayWave& rays_world) const;

 private:
  std::unique_ptr<BuiltScene> built_;
};

/// "Embree 3.13.5, 16 lanes": what traverses, and how wide on this machine.
[[nodiscard]] std::string traversal_version();

}  // namespace alhazen
