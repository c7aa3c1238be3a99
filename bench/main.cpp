// Google Benchmark's main, with what makes figures comparable written to their head.
#include <benchmark/benchmark.h>
#include <tbb/info.h>

#include <string>

#include "accel/accelerated_scene.h"

int main(int argc, char** argv) {
  benchmark::AddCustomContext("build", ALHAZEN_BUILD);
  benchmark::AddCustomContext("traversal", alhazen::traversal_version());
  benchmark::AddCustomContext(
      "threads", std::to_string(tbb::info::default_concurrency()) + " for build/ and render/, 1 for intersect/");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
