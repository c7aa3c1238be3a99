// How much memory the program has needed.
#pragma once

#include <cstdint>

namespace alhazen {

/// The largest resident set of this process so far, in bytes; 0 where the system does not tell.
[[nodiscard]] uint64_t peak_memory();

}  // namespace alhazen
