// Measurements of frames for people, for programs, and against earlier ones.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/frame_bench.h"

namespace alhazen {

/// Some lines, the last without a line break.
[[nodiscard]] std::string bench_text(const FrameBench& bench);

/// A table of the phases of a frame: share, milliseconds of each thread, nanoseconds of all threads for each ray; of
/// traversal, what Embree takes alone. Without a line break at its end.
[[nodiscard]] std::string breakdown_text(const FrameBench& bench);

/// {"machine": ..., "results": [...]}: what was measured, on what, by which versions; seconds and bytes.
[[nodiscard]] nlohmann::ordered_json bench_json(const std::vector<FrameBench>& benches);

/// How the frames of two files that `bench_json` gave differ, a line for each that is in both.
struct BenchComparison {
  std::string text;
  bool regressed = false;  // some frame takes longer, beyond chance
};

/// Scenes of the same name, size, samples, integrator, threads and build are paired. Slower or faster is what the
/// Mann-Whitney test of the frames' times finds at 1 %, and differs by 1 % or more. Throws LoadError where `before` is
/// no such file.
[[nodiscard]] BenchComparison compare_benches(const nlohmann::ordered_json& now, const std::string& before_file);

}  // namespace alhazen
