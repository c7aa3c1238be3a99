// What the callbacks of a wave's query are handed.
#pragma once

#include <cstdint>

#include "accel/embree.h"
#include "core/vec.h"

namespace alhazen {

/// A query whose shadow rays gather what the surfaces that they cross let through.
struct WaveQuery : embree::Query {
  Rgb* visible;                        // by ray id; shadow queries only
  const uint32_t* object_of_instance;  // Geometry's object number, by Embree's instance number
  // Counted by shapes' callbacks, to which the query is constant: how often they were called, and for how many lanes.
  mutable uint64_t shape_calls = 0, shape_lanes = 0;

  WaveQuery(Coherence rays, Rgb* visible_by_ray, const uint32_t* object_by_instance)
      : embree::Query(rays), visible(visible_by_ray), object_of_instance(object_by_instance) {}
};

}  // namespace alhazen
