// A benchmark of ours never stands alone: its rivals do the same in between, and it reports how many times as fast it
// is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace alhazen {

/// One iteration of a benchmark.
struct Work {
  std::function<void()> run;
  double count;  // of rays or primitives that `run` handles
};

/// `prepare` runs before any clock does and may keep what it builds.
struct Contender {
  std::string name;  // of a rival: "embree"
  std::function<Work()> prepare;
};

/// What counts: time on the wall, or the calling thread's time on a processor, which others on the machine disturb
/// less.
enum class Clock : uint8_t { wall, thread };

/// Ours and its rivals.
struct Contest {
  std::string name;  // what / how / on which scene: "intersect/sphere/camera/10000"
  const char* unit;  // "Mray/s" or "Mprim/s"
  Clock clock;
  std::function<Work()> prepare;
  std::vector<Contender> rivals;
};

/// Registers the contest with Google Benchmark. Iterations of all take turns, so that whatever else the machine does
/// hits all alike. Reported are our time and, from the fastest iteration of each: our rate in `unit`, `vs_` each rival,
/// and `doubts`, the share of our rays (on the calling thread) that doubles alone did not settle.
void register_contest(const Contest& contest);

}  // namespace alhazen
