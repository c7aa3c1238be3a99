// The primary rays of a scene's picture, judged against the whole scene.
//
//   A  shapes by the custom intersectors, as the renderer traverses them; triangles by the watertight one
//   B  shapes by Embree's own geometries, triangles by Embree's, as the renderer traverses them
//   J  the judge, over every surface whose box the ray passes
//
// The renderer shows A's shapes and B's triangles: `PictureTally` says how that compares with the truth.
#pragma once

#include <memory>

#include "accel/geometry.h"
#include "crosscheck/crosscheck.h"

namespace alhazen::crosscheck {

/// A picture's rays, by pixel from the top left.
struct View {
  int width = 0, height = 0;
  std::function<Rayf(int x, int y)> ray;
};

/// The renderer's own picture against the truth.
struct PictureTally {
  uint64_t pixels = 0, other_surface = 0;  // shows a surface, or none, where there is another
  double worst_t = 0;                      // floats, where the surface is right
  std::optional<uint64_t> example;         // a pixel of those
};

class SceneCheck {
 public:
  /// Surfaces as they stand: what materials cut out or let through is there. `geometry` must outlive it; it is changed
  /// for the time of this call alone. Throws as `AcceleratedScene` does.
  SceneCheck(Geometry& geometry, std::span<const std::string> node_names);
  ~SceneCheck();

  /// Cases are numbered y width + x and come cell by cell, as the renderer traces them, whatever the threads.
  [[nodiscard]] Tally check(const View& view, const Options& options, const Observer& observer,
                            PictureTally& picture) const;

  struct Impl;

 private:
  std::unique_ptr<const Impl> impl_;
};

}  // namespace alhazen::crosscheck
