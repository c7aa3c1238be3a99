// How hierarchies are built.
#pragma once

#include <cstdint>

namespace alhazen {

/// How much care a hierarchy's building takes. What is hit does not depend on it, but the order of equal distances may.
enum class BuildQuality : uint8_t {
  fast,      // Morton order: for previews
  balanced,  // surface area heuristic
  best       // with spatial splits, where Embree has them; its choices depend on threads, so bits may, too
};

}  // namespace alhazen
