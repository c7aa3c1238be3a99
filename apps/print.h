// Reports to standard output.
#pragma once

#include <cstdio>
#include <string>

#include "core/error.h"

namespace alhazen {

/// Throws WriteError where it does not arrive.
inline void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw WriteError("standard output", "cannot be written");
}

}  // namespace alhazen
