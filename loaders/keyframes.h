// Values that change with time: glTF's animation samplers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace alhazen {

enum class Interpolation : uint8_t { step, linear, cubic_spline };

struct Keyframes {
  Interpolation interpolation = Interpolation::linear;
  bool rotations = false;     // values are quaternions (x, y, z, w), none of them 0
  size_t width = 1;           // numbers of a value
  std::vector<float> times;   // seconds, never falling, at least one
  std::vector<float> values;  // `width` for each time; cubic splines: in-tangent, value and out-tangent for each
};

/// The value at `seconds`, which before the first key is the first value and after the last the last. Where two keys
/// share a time, the later one holds from there on. Quaternions are unit length; linear ones take the shorter way
/// around, at even speed. Source: glTF 2.0, appendix C.
[[nodiscard]] std::vector<double> value_at(const Keyframes& keys, double seconds);

}  // namespace alhazen
