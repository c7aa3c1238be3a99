// Lines that meet a surface in a special way, exactly: what only a convention can decide.
#pragma once

#include <span>

#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

enum class Tie : uint8_t {
  none,
  edge,      // through an edge, a vertex, a rim, or where surfaces of a composite meet
  tangent,   // touches the curved wall, or passes through an apex
  coplanar,  // runs within a face
};
[[nodiscard]] const char* name_of(Tie tie);

/// Whether the line, in the surface's own space, meets it so. Exact.
[[nodiscard]] Tie tie_of(const Surface& surface, const ExactLine& line);

}  // namespace alhazen::crosscheck
