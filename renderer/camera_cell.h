// Cells: the blocks of pixels that one wave belongs to, and the order in which it holds their camera rays.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/lanes.h"

namespace alhazen {

// Pixels a side of a cell, aligned to the image, so that the grouping of rays into packets never depends on tiles,
// threads or crops.
inline constexpr int kCellSize = 32;

struct Cell {
  int x0, y0, x1, y1;  // pixels, end exclusive
};

inline constexpr int kBlockSize = 4;  // pixels a side of what one packet sees
static_assert(kCellSize % kBlockSize == 0 && std::has_single_bit(unsigned(kCellSize)));

/// f(x, y) for every pixel, row by row in blocks of kBlockSize, block after block along Morton's curve, so that packets
/// find the nodes, and hits the texels, of their neighbours in the caches.
template <class F>
void for_each_pixel(const Cell& cell, const F& f) {
  const auto even_bits = [](unsigned morton) {
    unsigned bits = 0;
    for (unsigned k = 0; k < 8; ++k) bits |= (morton >> 2 * k & 1) << k;
    return int(bits);
  };
  constexpr unsigned kBlocksASide = kCellSize / kBlockSize;
  for (unsigned block = 0; block < kBlocksASide * kBlocksASide; ++block) {
    const int x0 = cell.x0 + even_bits(block) * kBlockSize, y0 = cell.y0 + even_bits(block >> 1) * kBlockSize;
    for (int y = y0; y < std::min(y0 + kBlockSize, cell.y1); ++y)
      for (int x = x0; x < std::min(x0 + kBlockSize, cell.x1); ++x) f(x, y);
  }
}

/// The same as rows of pixels from the cell's corner.
struct CellPixels {
  Lanes<int32_t> x, y;
  int width = 0, height = 0;  // of the cell that they are for

  [[nodiscard]] size_t size() const { return x.size(); }

  /// Nothing is to be done for a cell as large as the last.
  void list(const Cell& cell) {
    if (cell.x1 - cell.x0 == width && cell.y1 - cell.y0 == height) return;
    width = cell.x1 - cell.x0, height = cell.y1 - cell.y0;
    x.resize(0), y.resize(0);
    for_each_pixel({0, 0, width, height}, [&](int px, int py) { x.push(px), y.push(py); });
  }
};

}  // namespace alhazen
