// Which frames of an animation are rendered, when they are, and what their files are called.
#pragma once

#include <cstdint>
#include <string>

namespace alhazen {

/// first, first + step, ... as far as last; from a later to an earlier one where the step is negative.
struct FrameRange {
  int first = 0, last = 0, step = 1;

  [[nodiscard]] int count() const { return (last - first) / step + 1; }
  [[nodiscard]] int frame(int i) const { return first + i * step; }
};

/// "A", "A:B" or "A:B:STEP", of integers within ±10 million; A:B runs down where B < A. Throws UsageError otherwise.
[[nodiscard]] FrameRange parse_frames(const std::string& text);

/// Whether the name has a place for a frame's number: one or more #.
[[nodiscard]] bool has_frame_place(const std::string& pattern);

/// The last run of # in `pattern` replaced by the frame's number, with zeros before it where it is shorter.
[[nodiscard]] std::string frame_file(const std::string& pattern, int frame);

}  // namespace alhazen
