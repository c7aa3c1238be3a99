#include "loaders/load_limits.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

#include "core/error.h"

namespace alhazen {
namespace {

constexpr uint64_t kMost = std::numeric_limits<uint64_t>::max() / 4;  // sums of a few do not overflow
constexpr uint64_t kAnyScene = uint64_t{192} << 20, kForEachByte = 128;

}  // namespace

std::string memory_text(uint64_t bytes) {
  constexpr const char* kUnits[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  size_t unit = 0;
  double amount = double(bytes);
  for (; amount >= 1000 && unit + 1 < std::size(kUnits); ++unit) amount /= 1024;
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 || amount >= 100 ? "%.0f %s" : "%.1f %s", amount, kUnits[unit]);
  return text;
}

uint64_t memory_of_machine() {
  uint64_t bytes = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGE_SIZE));
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (uint64_t limit = 0; std::ifstream(file) >> limit) bytes = std::min(bytes, limit);
  return bytes;
}

LoadBudget::LoadBudget(const LoadLimits& limits) : limits_(limits), machine_(memory_of_machine() / 4 * 3) {}

uint64_t LoadBudget::limit() const {
  return limits_.memory ? limits_.memory : std::min(machine_, kAnyScene + kForEachByte * files_);
}

void LoadBudget::take_file(const std::string& place, uint64_t bytes) {
  {
    const std::lock_guard lock(mutex_);
    if (read_.insert(place).second) files_ += std::min(bytes, kMost / kForEachByte);
  }
  take(place, bytes);
}

void LoadBudget::take(const std::string& place, uint64_t bytes) {
  bytes = std::min(bytes, kMost);
  const uint64_t before = taken_.fetch_add(bytes), most = limit();
  if (before + bytes <= most) return;
  taken_ -= bytes;
  throw LoadError(place, "",
                  "needs " + memory_text(bytes) + " of memory, " + memory_text(before) + " of " + memory_text(most) +
                      " are taken; --max-memory raises the limit");
}

void LoadBudget::take(const JsonRef& r, uint64_t count, uint64_t bytes_each) {
  if (bytes_each > 0) take(r, count > kMost / bytes_each ? kMost : count * bytes_each);
}

}  // namespace alhazen
