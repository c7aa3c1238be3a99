// Pixels in memory, as they leave the renderer.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace alhazen {

/// Interleaved rows from the top left; one name for each channel, in the order in which they are stored.
template <class T>
struct PixelBuffer {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<T> pixels;  // height x width x channels.size()

  [[nodiscard]] const T* at(int x, int y) const {
    return &pixels[(size_t(y) * size_t(width) + size_t(x)) * channels.size()];
  }
  [[nodiscard]] T* at(int x, int y) { return &pixels[(size_t(y) * size_t(width) + size_t(x)) * channels.size()]; }
};

using ColorImage = PixelBuffer<float>;  // scene-linear R, G, B and perhaps A (colour premultiplied by it)
using IdImage = PixelBuffer<uint32_t>;  // node, primitive, material; kNone where there is none

}  // namespace alhazen
