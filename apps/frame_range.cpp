#include "apps/frame_range.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "core/error.h"

namespace alhazen {
namespace {

constexpr int kLargestFrame = 10'000'000;

bool valid(int frame) { return std::abs(frame) <= kLargestFrame; }

}  // namespace

FrameRange parse_frames(const std::string& text) {
  FrameRange range;
  int used[3] = {0, 0, 0};
  const int found = std::sscanf(text.c_str(), "%8d%n:%8d%n:%8d%n", &range.first, &used[0], &range.last, &used[1],
                                &range.step, &used[2]);
  const bool whole = found >= 1 && size_t(used[found - 1]) == text.size();
  if (found == 1) range.last = range.first;
  if (found == 2) range.step = range.last < range.first ? -1 : 1;
  const bool forward = range.step > 0 ? range.last >= range.first : range.last <= range.first;
  if (!whole || range.step == 0 || !forward || !valid(range.first) || !valid(range.last) || !valid(range.step))
    throw UsageError("--frames: '" + text + "' is not FIRST:LAST or FIRST:LAST:STEP, like 1:48 or 0:96:2");
  return range;
}

bool has_frame_place(const std::string& pattern) { return pattern.find('#') != std::string::npos; }

std::string frame_file(const std::string& pattern, int frame) {
  const size_t end = pattern.rfind('#') + 1, before = pattern.find_last_not_of('#', end - 1);
  const size_t begin = before == std::string::npos ? 0 : before + 1;
  char number[32];
  std::snprintf(number, sizeof number, "%0*d", int(std::min<size_t>(end - begin, 16)), frame);
  return pattern.substr(0, begin) + number + pattern.substr(end);
}

}  // namespace alhazen
