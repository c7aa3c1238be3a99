#include "apps/peak_memory.h"

#include <fstream>
#include <string>

namespace alhazen {

// Not getrusage: what it says goes on from the process that started this one.
uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  return 0;
}

}  // namespace alhazen
