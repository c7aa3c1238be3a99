// Cells: the blocks of pixels that one wave belongs to, and the order in which it holds their camera rays.
#pragma once

#include <cstdint>

#include "core/lanes.h"

namespace alhazen {

// Pixels a side of a cell, aligned to the image, so that the grouping of rays into packets never depends on tiles,
// threads or crops.
inline constexpr int kCellSize = 32;

struct Cell {
  int x0, y0, x1, y1;  // pixels, end exclusive
};

/// f(x, y) for every pixel, neighbours side by side in blocks of 4 x 4.
template <class F>
void for_each_pixel(const Cell& cell, const F& f) {
  for (int by = 0; by < kCellSize; by += 4)
    for (int bx = 0; bx < kCellSize; bx += 4)
      for (int k = 0; k < 16; ++k) {
        const int x = cell.x0 + bx + k % 4, y = cell.y0 + by + k / 4;
        if (x < cell.x1 && y < cell.y1) f(x, y);
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
