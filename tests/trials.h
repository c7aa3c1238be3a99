// How often to try: as often as is asked, or a twentieth of it where a sanitizer makes exact arithmetic, which
// allocates, some hundred times as slow.
#pragma once

#include <algorithm>

namespace alhazen {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int kFewerTrials = 20;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr int kFewerTrials = 20;
#else
inline constexpr int kFewerTrials = 1;
#endif
#else
inline constexpr int kFewerTrials = 1;
#endif

[[nodiscard]] constexpr int trials(int count) { return std::max(1, count / kFewerTrials); }

}  // namespace alhazen
