// The rays of a frame as they were asked about, wave by wave: what it takes to trace them again without the renderer.
#pragma once

#include <mutex>
#include <vector>

#include "accel/wave.h"

namespace alhazen {

/// Rays of a kind are alike in how they run, and are best asked about in the same way.
enum class WaveKind : uint8_t { camera, camera_shadow, bounced, bounced_shadow };
inline constexpr size_t kWaveKinds = 4;

[[nodiscard]] constexpr bool is_shadow(WaveKind kind) {
  return kind == WaveKind::camera_shadow || kind == WaveKind::bounced_shadow;
}

struct LoggedWave {
  WaveKind kind;
  RayWave rays;
};

/// The waves of a cell in their order.
using CellWaves = std::vector<LoggedWave>;

[[nodiscard]] inline LoggedWave logged(WaveKind kind, const RayWave& rays) {
  LoggedWave copy{kind, {}};
  copy.rays.resize(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) copy.rays.set(i, rays.get(i));
  copy.rays.time.resize(rays.time.size());
  for (size_t i = 0; i < rays.time.size(); ++i) copy.rays.time[i] = rays.time[i];
  return copy;
}

/// Filled by many threads.
class WaveLog {
 public:
  void add(CellWaves cell) {
    const std::lock_guard lock(mutex_);
    cells_.push_back(std::move(cell));
  }
  [[nodiscard]] const std::vector<CellWaves>& cells() const { return cells_; }

 private:
  std::mutex mutex_;
  std::vector<CellWaves> cells_;
};

}  // namespace alhazen
