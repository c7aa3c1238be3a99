#include "renderer/hits_by_group.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace alhazen {
namespace {

using U = UintOf<ShadingLanes>;
constexpr size_t kLanes = kWidthOf<U>;

constexpr size_t kShortRun = 4;  // for which lanes are not worth their latency

/// Where the run that starts at `first` ends. Rows are readable up to a multiple of the lanes.
size_t end_of_run(const HitWave& hits, size_t first) {
  const uint32_t object = hits.object[first], part = hits.part[first];
  const size_t n = hits.object.size(), near = std::min(n, first + kShortRun);
  for (; first < near; ++first)
    if (hits.object[first] != object || (object != kNone && hits.part[first] != part)) return first;
  uint32_t before = (1u << first % kLanes) - 1;  // lanes of the first block that do not count
  for (size_t block = first - first % kLanes; block < n; block += kLanes) {
    const auto row = [&](const Lanes<uint32_t>& of) { return U(&of[block], std::experimental::element_aligned); };
    uint32_t alike = lane_bits(row(hits.object) == U(object));
    if (object != kNone) alike &= lane_bits(row(hits.part) == U(part));
    const auto count = size_t(std::countr_one(alike | std::exchange(before, 0)));
    if (count < kLanes) return std::min(block + count, n);
  }
  return n;
}

}  // namespace

void sort_by_group(const HitWave& hits, const Geometry& geometry, const ShadingGroups& groups, HitsByGroup& out) {
  const size_t n = hits.object.size(), misses = groups.size();
  out.ends.resize(misses + 1), out.sorted.resize(n), out.runs.resize(0);
  std::fill_n(out.ends.data(), out.ends.size(), 0);
  for (size_t first = 0; first < n;) {
    const uint32_t object = hits.object[first];
    const uint32_t group = object == kNone ? uint32_t(misses) : groups.of(geometry, object, hits.part[first]);
    const size_t end = end_of_run(hits, first);
    out.runs.push({group, uint32_t(first), uint32_t(end)});
    out.ends[group] += uint32_t(end - first);
    first = end;
  }
  std::exclusive_scan(out.ends.data(), out.ends.data() + out.ends.size(), out.ends.data(), 0u);
  for (size_t i = 0; i < out.runs.size(); ++i) {
    const HitsByGroup::Run& run = out.runs[i];
    uint32_t& place = out.ends[run.group];
    std::iota(&out.sorted[place], &out.sorted[place] + (run.end - run.first), run.first);
    place += run.end - run.first;
  }
}

}  // namespace alhazen
