// A subject as Embree's own geometries hold it: in floats.
#pragma once

#include <optional>

#include "crosscheck/subject.h"

namespace alhazen::crosscheck {

struct NativeSubject {
  Subject subject;
  bool rounded = false;  // another surface than the one that was asked for, if only by roundings
};

/// None where floats cannot hold the surface: a polygon that would not be flat, a size or a map that becomes 0 or
/// infinite; and for quadrics and composites, which Embree has not.
[[nodiscard]] std::optional<NativeSubject> native_subject(const Subject& subject);

}  // namespace alhazen::crosscheck
