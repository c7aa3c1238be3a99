// Samples of eight bits as light.
#pragma once

#include <array>

#include "materials/texture.h"

namespace alhazen {

/// By ColorSpace and byte.
extern const std::array<std::array<float, 256>, 2> kLightOfByte;

/// byte / 255 as the division rounds it, and kLightOfByte has it: 0x1.01p-8 times a byte has no rounding.
template <class F>
F linear_byte(const F& byte) {
  return byte * F(0x1.01p-8f) + byte * F(0x1.010102p-24f);
}

}  // namespace alhazen
