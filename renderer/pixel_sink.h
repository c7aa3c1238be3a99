// Where light on its way to pixels goes, and whoever wants to know of it.
#pragma once

#include "renderer/trace_observer.h"

namespace alhazen {

/// `observed`: whether the arena's observer is told. Nothing of it is left in the code where not.
template <bool observed>
struct PixelSink {
  WaveArena& arena;
  Rgb* radiance;  // of the cell's pixels

  /// Calls event(observer).
  template <class Event>
  void tell(const Event& event) const {
    if constexpr (observed) event(*arena.observer);
  }

  void add(uint32_t pixel, LightTerm term, const Rgb& light) const {
    radiance[pixel] += light;
    tell([&](TraceObserver& observer) { observer.add(term, light); });
  }
};

}  // namespace alhazen
