#include "bench/contest.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <limits>

#include "accel/shape_hits.h"

namespace alhazen {
namespace {

double now(Clock clock) {
  timespec time;
  clock_gettime(clock == Clock::thread ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

double seconds_of(const Work& work, Clock clock) {
  const double start = now(clock);
  work.run();
  return now(clock) - start;
}

void run(benchmark::State& state, const Contest& contest) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Work ours = contest.prepare();
  std::vector<Work> rivals;
  for (const Contender& rival : contest.rivals) rivals.push_back(rival.prepare());
  std::vector<double> fastest_rival(rivals.size(), kNone);
  double fastest = kNone;
  uint64_t doubts = 0;
  for (auto _ : state) {
    for (size_t k = 0; k < rivals.size(); ++k)
      fastest_rival[k] = std::min(fastest_rival[k], seconds_of(rivals[k], contest.clock));
    const uint64_t before = doubt_counts().quad;
    const double seconds = seconds_of(ours, contest.clock);
    doubts = doubt_counts().quad - before;
    fastest = std::min(fastest, seconds);
    state.SetIterationTime(seconds);
  }
  state.counters[contest.unit] = ours.count / fastest * 1e-6;
  state.counters["doubts"] = double(doubts) / ours.count;
  for (size_t k = 0; k < rivals.size(); ++k)
    state.counters["vs_" + contest.rivals[k].name] = fastest_rival[k] / fastest;
}

}  // namespace

void register_contest(const Contest& contest) {
  benchmark::RegisterBenchmark(contest.name.c_str(), [=](benchmark::State& state) { run(state, contest); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace alhazen
