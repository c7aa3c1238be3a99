#include "inspect/legend.h"

#include <algorithm>

#include "loaders/draw_text.h"

namespace alhazen {
namespace {

constexpr int kRow = 20, kMargin = 10, kSwatch = 14, kType = 12, kWidth = 300, kNoteWidth = 96, kFewestRows = 12;
constexpr Rgb kPaper{0.012f, 0.012f, 0.014f}, kInk{0.8f, 0.8f, 0.8f}, kFaint{0.35f, 0.35f, 0.35f};

void fill(ColorImage& page, int x0, int y0, int x1, int y1, const Rgb& color) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      float* out = page.at(x, y);
      out[0] = color.r, out[1] = color.g, out[2] = color.b, out[3] = 1;
    }
}

/// Type is rather more than half as wide as high.
std::string fitted(const std::string& text, int width) {
  const auto room = size_t(width * 100 / (kType * 58));
  return text.size() <= room ? text : text.substr(0, room - 3) + "...";
}

void draw_row(ColorImage& page, int x, int y, const LegendRow& row) {
  fill(page, x, y + 3, x + kSwatch, y + 3 + kSwatch, row.color);
  const int text_x = x + kSwatch + 8, note_x = page.width - kNoteWidth;
  draw_text(page, text_x, y + kSwatch + 1, fitted(row.name, note_x - text_x - 4), kType, kInk);
  draw_text(page, note_x, y + kSwatch + 1, row.note, kType, kFaint);
}

}  // namespace

ColorImage with_legend(const ColorImage& picture, const std::vector<LegendRow>& rows) {
  const int few = std::min(int(rows.size()), kFewestRows);
  const int height = std::max(picture.height, few * kRow + 2 * kMargin);
  ColorImage page{picture.width + kWidth, height, {"R", "G", "B", "A"}, {}};
  page.pixels.resize(size_t(page.width) * size_t(height) * 4);
  fill(page, 0, 0, page.width, height, kPaper);
  for (int y = 0; y < picture.height; ++y) std::copy_n(picture.at(0, y), size_t(picture.width) * 4, page.at(0, y));

  const auto room = size_t((height - 2 * kMargin) / kRow);
  const size_t shown = rows.size() <= room ? rows.size() : room - 1;
  const int x = picture.width + kMargin;
  for (size_t i = 0; i < shown; ++i) draw_row(page, x, kMargin + int(i) * kRow, rows[i]);
  if (shown < rows.size())
    draw_text(page, x + kSwatch + 8, kMargin + int(shown) * kRow + kSwatch + 1,
              "and " + std::to_string(rows.size() - shown) + " more", kType, kFaint);
  return page;
}

}  // namespace alhazen
