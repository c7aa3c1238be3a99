// Measurements of frames as a drawing.
#pragma once

#include <string>
#include <vector>

#include "apps/frame_bench.h"

namespace alhazen {

/// An SVG document of its own. Bars: millions of rays a second, for each scene those of the whole frame (every ray over
/// the frame's time) and those of bare Embree by kind of wave, with the largest number of threads measured. Below,
/// where scenes were measured with several numbers of threads, lines: how many times as fast as with the least.
[[nodiscard]] std::string bench_svg(const std::vector<FrameBench>& benches);

}  // namespace alhazen
