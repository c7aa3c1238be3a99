// Random numbers by counting: every ray of every population is a function of its seed and its number alone.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include "core/vec.h"

namespace alhazen::crosscheck {

/// SplitMix64 (Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, 2014).
class Random {
 public:
  Random(std::initializer_list<uint64_t> key) {
    for (const uint64_t k : key) state_ = mix(state_ ^ k) + k;
  }
  uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15u); }
  double uniform(double lower = -1, double upper = 1) {
    return lower + (upper - lower) * (double(bits() >> 11) * 0x1p-53);
  }
  /// An integer in [lower, upper].
  int integer(int lower, int upper) { return lower + int(bits() % uint64_t(upper - lower + 1)); }
  bool coin() { return bits() >> 63; }
  /// Between 10^lower and 10^upper.
  double decades(double lower, double upper) { return std::pow(10, uniform(lower, upper)); }
  Vec3d in_cube(double half = 1) {
    const double x = uniform(-half, half), y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  Vec3d on_sphere() {
    const double z = uniform(), angle = uniform(0, 6.283185307179586), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  Vec3d on_lattice(int half) {
    const int x = integer(-half, half), y = integer(-half, half);
    return {double(x), double(y), double(integer(-half, half))};
  }

 private:
  static uint64_t mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  uint64_t state_ = 0x9e3779b97f4a7c15u;
};

/// `x` moved by a number of floats.
inline float moved_by_floats(float x, int count) {
  const float towards = std::copysign(std::numeric_limits<float>::infinity(), float(count));
  for (int i = 0; i < std::abs(count); ++i) x = std::nextafter(x, towards);
  return x;
}

}  // namespace alhazen::crosscheck
