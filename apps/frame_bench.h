// What a frame costs, beside what Embree alone takes for its rays.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "apps/progress.h"
#include "renderer/render.h"

namespace alhazen {

/// Rays of one kind and the fastest way to ask bare Embree about them.
struct BareKind {
  uint64_t rays = 0;
  BareCall best;
  double seconds = 0;  // of all threads, once
};

/// One scene, on one number of threads. Samples of the same index were taken one after the other.
struct FrameBench {
  std::string scene;  // file name
  int threads = 1;
  RenderOptions options;
  BuildOptions build;
  double load_s = 0, build_s = 0, first_tile_s = 0;  // the last from before loading
  uint64_t primitives = 0, hierarchy_bytes = 0, peak_bytes = 0;
  RayCounts rays;
  std::array<BareKind, kWaveKinds> bare;
  std::vector<double> frame_s;      // wall time of a whole frame
  std::vector<double> traversal_s;  // of bare Embree on the same rays, each kind by its best call: mean of the threads
  std::vector<double> single_s;     // the same with one ray a call
  std::array<double, kPhases> phase_s{};  // of a frame, mean of the threads: by Phase; what is left was idle

  /// By how much of a frame's time Embree alone would do; pairs of samples, so that a machine's drift cancels.
  [[nodiscard]] std::vector<double> efficiencies() const;
};

/// Loads a scene and measures `repeats` frames for each number of threads.
/// @throw LoadError  as `load_gltf`
[[nodiscard]] std::vector<FrameBench> bench_frames(const std::string& file, const RenderOptions& options,
                                                   const BuildOptions& build, const std::vector<int>& threads,
                                                   int repeats);

}  // namespace alhazen
