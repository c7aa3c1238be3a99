#include "apps/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "loaders/draw_text.h"

namespace alhazen {
namespace {

constexpr int kGap = 6, kType = 12, kCaption = 36;
constexpr Rgb kPaper{0.012f, 0.012f, 0.014f}, kInk{0.8f, 0.8f, 0.8f}, kFaint{0.3f, 0.3f, 0.3f}, kAlarm{1, 0.1f, 0.05f};

int columns_of(const SheetLayout& layout, size_t cells) {
  if (layout.columns > 0) return layout.columns;
  const double ratio = double(layout.picture_height + kCaption + kGap) / (layout.picture_width + kGap);
  return std::max(1, int(std::lround(std::sqrt(double(cells) * ratio))));
}

void paste(const ColorImage& picture, int x0, int y0, ColorImage& page) {
  for (int y = 0; y < std::min(picture.height, page.height - y0); ++y)
    for (int x = 0; x < std::min(picture.width, page.width - x0); ++x)
      std::copy_n(picture.at(x, y), 3, page.at(x0 + x, y0 + y));
}

/// As much of it as a width has room for: type is rather more than half as wide as high.
std::string fitted(const std::string& text, int width, bool keep_end) {
  const auto room = size_t(std::max(4, width * 100 / (kType * 58)));
  if (text.size() <= room) return text;
  return keep_end ? "..." + text.substr(text.size() - room + 3) : text.substr(0, room - 3) + "...";
}

}  // namespace

std::array<int, 2> sheet_size(const SheetLayout& layout, size_t cells) {
  const int columns = columns_of(layout, cells);
  const int rows = int((cells + size_t(columns) - 1) / size_t(columns));
  return {kGap + columns * (layout.picture_width + kGap), kGap + rows * (layout.picture_height + kCaption + kGap)};
}

ColorImage contact_sheet(const SheetLayout& layout, const std::vector<SheetCell>& cells) {
  const auto [width, height] = sheet_size(layout, cells.size());
  ColorImage page{width, height, {"R", "G", "B", "A"}, {}};
  page.pixels.resize(size_t(width) * size_t(height) * 4);
  for (size_t i = 0; i < page.pixels.size(); i += 4)
    page.pixels[i] = kPaper.r, page.pixels[i + 1] = kPaper.g, page.pixels[i + 2] = kPaper.b, page.pixels[i + 3] = 1;
  const auto columns = size_t(columns_of(layout, cells.size()));
  for (size_t i = 0; i < cells.size(); ++i) {
    const SheetCell& cell = cells[i];
    const int x = kGap + int(i % columns) * (layout.picture_width + kGap);
    const int y = kGap + int(i / columns) * (layout.picture_height + kCaption + kGap);
    const int below = y + layout.picture_height;
    paste(cell.picture, x, y, page);
    draw_text(page, x, below + kType + 2, fitted(cell.title, layout.picture_width, true), kType,
              cell.failed ? kAlarm : kInk);
    draw_text(page, x, below + 2 * kType + 6, fitted(cell.facts, layout.picture_width, false), kType, kFaint);
  }
  return page;
}

}  // namespace alhazen
