// Seeded random numbers for tests.
#pragma once

#include <random>

#include "core/vec.h"

namespace alhazen {

class Uniform {
 public:
  explicit Uniform(unsigned seed) : engine_(seed) {}
  float operator()(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
  uint32_t bits() { return uint32_t(engine_()); }
  Vec3f direction() {
    for (;;) {
      const Vec3f v{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
      if (dot(v, v) > 0.01f && dot(v, v) < 1) return normalize(v);
    }
  }

 private:
  std::mt19937 engine_;
};

}  // namespace alhazen
