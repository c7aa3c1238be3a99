// The triangles of hits side by side.
#pragma once

#include <optional>

#include "renderer/lane_hits.h"
#include "renderer/triangle_point.h"

namespace alhazen {

/// Of hits that are all on meshes: what their triangles bring, and where they stand. Kilobytes, to be built where they
/// stay.
struct LaneTriangles {
  Corners<ShadingLanes> corners;
  std::optional<LaneMap> world_from_object;  // none where all lie in the world
  DoubleOf<ShadingLanes> roundings;          // of a position, in units of kUlp

  /// `has`: what is asked of the corners beside positions.
  LaneTriangles(const Scene& scene, const LaneHits& hits, const Attributes& has);
  [[nodiscard]] const LaneMap* map() const { return world_from_object ? &*world_from_object : nullptr; }

 private:
  void set_maps(const MeshInstances& instances, const LaneHits& hits);
};

}  // namespace alhazen
