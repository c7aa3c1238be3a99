// How far a render is, for people at a terminal, for log files, and for programs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "loaders/load_limits.h"
#include "renderer/render.h"

namespace alhazen {

enum class ProgressStyle : uint8_t {
  automatic,  // renewed on a terminal, plain elsewhere
  renewed,    // one line of standard error, written over and over
  plain,      // a line of standard error now and then
  json,       // one JSON object a line on standard output
  none,
};

/// `automatic` resolved for this process's standard error.
[[nodiscard]] ProgressStyle resolve(ProgressStyle style);

struct RayCounts {
  uint64_t camera = 0, mirror = 0, refracted = 0, shadow = 0;
  [[nodiscard]] uint64_t all() const { return camera + mirror + refracted + shadow; }
};

[[nodiscard]] RayCounts ray_counts(const RenderControl& control);

/// One moment of a render.
struct Progress {
  uint32_t tiles = 0, all_tiles = 0;
  double fraction = 0;  // of the pixels, 0 to 1
  uint64_t rays = 0;
  double seconds = 0;  // since the render began

  /// As long as what is left takes at the speed so far; negative where nothing is known yet.
  [[nodiscard]] double seconds_left() const { return fraction > 0 ? seconds * (1 - fraction) / fraction : -1; }
  [[nodiscard]] double rays_per_second() const { return seconds > 0 ? double(rays) / seconds : 0; }
};

/// "showcase 1280x720 16 spp  [612/920 tiles  66%]  15.9 Mray/s  4.1 s elapsed  2.1 s left"
[[nodiscard]] std::string progress_text(const std::string& title, const Progress& progress);

/// {"event": "progress", ...}; docs/rendering.md lists the keys.
[[nodiscard]] std::string progress_json(const Progress& progress);

/// "showcase  images 12/48  2.1 s elapsed"
[[nodiscard]] std::string progress_text(const std::string& title, const LoadProgress& progress, double seconds);

/// {"event": "loading", ...}
[[nodiscard]] std::string progress_json(const LoadProgress& progress, double seconds);

/// "4.1 s", "2:05", "1:02:05"
[[nodiscard]] std::string duration_text(double seconds);

/// Seconds from one report to the next after `elapsed` seconds: reports come more slowly as a render gets long.
[[nodiscard]] double report_interval(ProgressStyle style, double elapsed);

/// Reports on a render, or on loading that takes longer than a second, from its own thread for as long as it lives, and
/// never waits for a slow reader.
class ProgressReporter {
 public:
  /// `control` must outlive it; `pixels` is the picture's count of pixels.
  ProgressReporter(ProgressStyle style, std::string title, uint64_t pixels, const RenderControl& control);
  /// `progress` must outlive it.
  ProgressReporter(ProgressStyle style, std::string title, const LoadProgress& progress);
  ~ProgressReporter();
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

 private:
  struct Impl;
  explicit ProgressReporter(Impl* impl);  // owned

  std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen
