// A benchmark of ours never stands alone: it is registered with the one of Embree that it is compared to, and reports
// the ratio.
#pragma once

#include <functional>
#include <string>

namespace alhazen {

/// One iteration of a benchmark.
struct Work {
  std::function<void()> run;
  double count;  // of rays or primitives that `run` handles
};

/// Two ways to do the same. `prepare_` functions run before the clock does and may keep what they build.
struct Pair {
  std::string embree_name, our_name;  // what / on which scene / how: "intersect/sphere/user_geometry/camera/10000"
  const char* unit;                   // "Mray/s" or "Mprim/s"
  std::function<Work()> prepare_embree, prepare_ours;
};

/// Registers both with Google Benchmark, Embree's first. Ours reports `vs_embree`, how many times as fast it is, where
/// both run.
void register_pair(const Pair& pair);

}  // namespace alhazen
