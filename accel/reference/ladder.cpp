#include "accel/reference/ladder.h"

#include "accel/reference/node_tree.h"

namespace alhazen {

std::vector<Rung> reference_ladder(const Geometry& geometry, const SurfaceFilter& filter,
                                   const FilmProjection& projection) {
  std::vector<Rung> rungs;
  rungs.push_back({"every primitive", std::make_unique<BruteForce>(geometry, filter)});
  rungs.push_back({"object boxes", std::make_unique<ObjectBoxes>(geometry, filter)});
  rungs.push_back({"node tree", std::make_unique<NodeTree>(geometry, filter)});
  rungs.push_back({"image rectangles", std::make_unique<ScreenBoxes>(geometry, filter, projection)});
  return rungs;
}

}  // namespace alhazen
