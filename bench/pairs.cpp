#include "bench/pairs.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <memory>

namespace alhazen {
namespace {

/// Runs and counts the work; returns the seconds of one iteration.
double measure(benchmark::State& state, const Work& work, const char* unit) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  for (auto _ : state) work.run();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  state.counters[unit] = benchmark::Counter(work.count * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
  return seconds / double(state.iterations());
}

}  // namespace

void register_pair(const Pair& pair) {
  const auto embree_seconds = std::make_shared<double>(0.0);
  benchmark::RegisterBenchmark(
      pair.embree_name.c_str(),
      [=](benchmark::State& state) { *embree_seconds = measure(state, pair.prepare_embree(), pair.unit); })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(pair.our_name.c_str(),
                               [=](benchmark::State& state) {
                                 const double seconds = measure(state, pair.prepare_ours(), pair.unit);
                                 if (*embree_seconds > 0) state.counters["vs_embree"] = *embree_seconds / seconds;
                               })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace alhazen
