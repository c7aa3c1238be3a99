// How much a file may ask for, and the count of what it has been given.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>

#include "loaders/json_ref.h"

namespace alhazen {

struct LoadLimits {
  uint64_t memory = 0;                        // bytes; 0: by the machine's memory and the size of the files
  uint64_t json = uint64_t{1} << 28;          // bytes
  uint64_t image_pixels = uint64_t{1} << 28;  // of one image
  uint64_t node_depth = 4096;                 // nodes from a root to the deepest below it
  bool ignore_required = false;               // takes files that require extensions that nobody knows
};

/// How far loading is, for another thread to watch.
struct LoadProgress {
  std::atomic<const char*> phase{"reading"};  // text that lives as long as the program
  std::atomic<uint64_t> done{0}, all{0};      // of what the phase goes through; all 0: that cannot be counted

  void begin(const char* next_phase, uint64_t count = 0) noexcept { phase = next_phase, done = 0, all = count; }
};

/// Counts what a scene takes while it is loaded and built, each part before it takes it, from any thread. The counts
/// are estimates from above, and what is freed on the way is not taken off: whether a scene is let through does not
/// depend on how fast its parts come.
///
/// Without a limit of its own a scene may take 192 MiB and 128 bytes for each byte of its files, and no more than three
/// quarters of the memory that the machine, or the control group, has.
class LoadBudget {
 public:
  explicit LoadBudget(const LoadLimits& limits = {});

  [[nodiscard]] const LoadLimits& limits() const { return limits_; }
  [[nodiscard]] uint64_t taken() const { return taken_; }  // bytes
  [[nodiscard]] uint64_t left() const { return limit() - std::min<uint64_t>(limit(), taken_); }

  /// A file's own bytes; a file that is read again lets through no more.
  void take_file(const std::string& place, uint64_t bytes);
  /// Throws LoadError at `place` where that is too much.
  void take(const std::string& place, uint64_t bytes);
  void take(const JsonRef& r, uint64_t bytes) { take(r.place(), bytes); }
  /// count x bytes_each, which may overflow.
  void take(const JsonRef& r, uint64_t count, uint64_t bytes_each);

  LoadProgress progress;

 private:
  [[nodiscard]] uint64_t limit() const;

  LoadLimits limits_;
  uint64_t machine_;
  std::atomic<uint64_t> taken_{0}, files_{0};
  std::mutex mutex_;
  std::set<std::string> read_;
};

/// "1.5 GiB"
[[nodiscard]] std::string memory_text(uint64_t bytes);

/// Bytes of memory that this process may hope for: the machine's, or its control group's where that is less.
[[nodiscard]] uint64_t memory_of_machine();

}  // namespace alhazen
