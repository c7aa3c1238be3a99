// Where the time of a frame goes: a clock that is always in one of a few phases.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <utility>

namespace alhazen {

/// What a thread does for a wave. `shading` includes the rays that are spawned and, unless the clock splits it, the two
/// before it: where surfaces were hit, and what their textures say of them.
enum class Phase : uint8_t { generation, traversal, surface_points, textures, shading, film };
inline constexpr size_t kPhases = 6;

using PhaseNanoseconds = std::array<uint64_t, kPhases>;

/// One thread's. Read a few times a wave, not a ray: it costs some tens of nanoseconds.
class PhaseClock {
 public:
  bool splits_shading = false;  // read for each few hits as well, which takes a few hundredths of a frame

  /// Time from now on belongs to this phase.
  void enter(Phase phase) {
    const auto now = Clock::now();
    add(now);
    phase_ = int(phase), since_ = now;
  }

  /// The same for a part of shading, where that is split.
  void enter_part(Phase phase) {
    if (splits_shading) enter(phase);
  }

  /// Ends the phase; the sums so far, which start anew.
  [[nodiscard]] PhaseNanoseconds take() {
    add(Clock::now());
    phase_ = -1;
    return std::exchange(sums_, {});
  }

 private:
  using Clock = std::chrono::steady_clock;

  void add(Clock::time_point now) {
    if (phase_ >= 0) sums_[size_t(phase_)] += uint64_t(std::chrono::nanoseconds(now - since_).count());
  }

  PhaseNanoseconds sums_{};
  int phase_ = -1;
  Clock::time_point since_;
};

}  // namespace alhazen
