// Ctrl-C and SIGTERM: the first one stops the work and saves what is finished, a second one, 0.2 s later or more, ends
// at once.
#pragma once

#include <atomic>

namespace alhazen {

/// From now on SIGINT and SIGTERM end the program with status 128 + signal and leave no temporary file. Writing to a
/// closed pipe, past a file size limit, or to a terminal that is gone becomes an ordinary error of that write.
void catch_signals();

/// From now on the first SIGINT or SIGTERM sets `stop` instead, which must live as long as the program. One that came
/// before has ended it already.
void stop_on_signal(std::atomic<bool>& stop);

/// The signal that has set `stop`, 0 for none.
[[nodiscard]] int caught_signal();

}  // namespace alhazen
