#include "apps/crosscheck_map.h"

#include <algorithm>
#include <cmath>

#include "loaders/draw_text.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

using namespace crosscheck;

constexpr int kGap = 16, kType = 13, kLine = 20;  // pixels
constexpr int kSmallSheet = 256, kLargeSheet = 512, kLegendWidth = 720;
constexpr double kFewMarks = 1.0 / 300;  // of the pixels: then they are marked larger than they are

using Color = std::array<uint8_t, 3>;
constexpr Color kInk = {40, 40, 40}, kPaper = {255, 255, 255}, kOutline = {120, 120, 120};

/// Okabe and Ito's colours, which the colour-blind tell apart.
struct Meaning {
  Color color;
  const char* text;
};
constexpr Meaning kMeanings[kMarks] = {
    {{214, 214, 214}, "AGREE: nobody is wrong"},
    {{0, 158, 115}, "TIE: a convention decides, and the custom one keeps it"},
    {{86, 180, 233}, "A_RIGHT: Embree's t is off"},
    {{0, 114, 178}, "A_RIGHT: Embree misses, hits what is not there, or takes one surface or face for another"},
    {{213, 94, 0}, "B_RIGHT: the custom one is wrong, Embree right"},
    {{0, 0, 0}, "BOTH_WRONG: the custom one is wrong, nobody is right"},
    {{204, 121, 167}, "UNEXPLAINED: the judge contradicts itself"}};

Rgb linear(const Color& c) {
  return Rgb(linear_from_srgb(float(c[0]) / 255), linear_from_srgb(float(c[1]) / 255),
             linear_from_srgb(float(c[2]) / 255));
}

void put(ColorImage& image, int x, int y, const Color& color) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  const Rgb c = linear(color);
  float* out = image.at(x, y);
  out[0] = c.r, out[1] = c.g, out[2] = c.b, out[3] = 1;
}

void fill(ColorImage& image, int x0, int y0, int width, int height, const Color& color) {
  for (int y = y0; y < y0 + height; ++y)
    for (int x = x0; x < x0 + width; ++x) put(image, x, y, color);
}

ColorImage blank(int width, int height) {
  ColorImage image{width, height, {"R", "G", "B", "A"}, std::vector<float>(size_t(width) * size_t(height) * 4, 1.0f)};
  return image;
}

Color mixed(const Color& a, const Color& b, double share) {
  Color out{};
  for (size_t k = 0; k < 3; ++k) out[k] = uint8_t(std::lround(a[k] + (b[k] - a[k]) * share));
  return out;
}

/// Of the worst mark; where it is Embree's alone, or a tie, the colour tells the share of such rays.
Color cell_color(const VerdictSheet::Cell& cell) {
  const uint32_t rays = cell.rays();
  if (rays == 0) return kPaper;
  int worst = 0;
  for (int k = 0; k < kMarks; ++k)
    if (cell.count[size_t(k)] > 0) worst = k;
  if (worst == 0 || Mark(worst) >= Mark::custom_wrong) return mark_color(Mark(worst));
  const double share = double(cell.of(Mark(worst))) / rays;
  return mixed(mark_color(Mark::agree), mark_color(Mark(worst)), 0.25 + 0.75 * std::sqrt(share));
}

int columns_for(size_t sheets) { return std::max(1, int(std::ceil(std::sqrt(double(sheets) * 1.6)))); }

}  // namespace

std::array<uint8_t, 3> mark_color(Mark mark) { return kMeanings[size_t(mark)].color; }

CrosscheckMap::CrosscheckMap(int width, int height, size_t families)
    : width_(width),
      height_(height),
      side_(families > 1 ? kSmallSheet : kLargeSheet),
      pixels_(size_t(width) * size_t(height)) {}

void CrosscheckMap::add(const std::string& family, const Case& c) {
  const bool picture = !pixels_.empty();
  if (picture != (c.population == Population::camera)) return;
  if (c.verdict == Verdict::out_of_domain) return void(++outside_);
  ++counts_[size_t(mark_of(c))];
  if (picture)
    add_pixel(c);
  else
    add_to_sheet(family, c);
}

void CrosscheckMap::add_pixel(const Case& c) {
  Pixel& pixel = pixels_[c.index];
  pixel.mark = mark_of(c), pixel.object = c.object;
  if (c.object != kNone) pixel.grey = uint8_t(170 + 65 * std::clamp(c.facing, 0.0, 1.0));
}

void CrosscheckMap::add_to_sheet(const std::string& family, const Case& c) {
  constexpr const char* kTitles[kSheetKinds] = {"", ", flat faces", ", seen along the rays"};
  const auto [found, is_new] = sheets_of_.try_emplace(family, sheets_.size());
  if (is_new)
    for (const char* title : kTitles) sheets_.push_back({family + title, VerdictSheet(side_)});
  for (const MapPlace& place : map_places(c))
    sheets_[found->second + size_t(place.sheet)].verdicts.add(place, mark_of(c));
  misses_ += !c.truth.hit && mark_of(c) == Mark::agree;
}

std::string CrosscheckMap::legend() const {
  std::string text;
  for (size_t k = 0; k < kMarks; ++k) text += std::string(kMeanings[k].text) + ": " + std::to_string(counts_[k]) + "\n";
  return text;
}

void CrosscheckMap::write(ColorImage& image, int x, int y, const std::string& text) const {
  has_text_ = has_text_ && draw_text(image, x, y, text, kType, linear(kInk));
}

/// One swatch and line for each mark, and what is not in the picture.
void CrosscheckMap::draw_legend(int y0, ColorImage& image) const {
  for (int k = 0; k < kMarks; ++k) {
    const int y = y0 + k * kLine;
    fill(image, kGap, y, 12, 12, mark_color(Mark(k)));
    write(image, kGap + 20, y + 11, std::string(kMeanings[k].text) + ": " + std::to_string(counts_[size_t(k)]));
  }
  std::string rest;
  if (pixels_.empty())
    rest = "surfaces: u to the right, v down, without the rays of which nobody says that they hit: " +
           std::to_string(misses_);
  if (outside_ > 0) rest += (rest.empty() ? "" : "; ") + ("out of the domain: " + std::to_string(outside_));
  write(image, kGap, y0 + kMarks * kLine + 11, rest);
}

void CrosscheckMap::draw_picture(ColorImage& image) const {
  const auto at = [&](int x, int y) -> const Pixel& { return pixels_[size_t(y) * size_t(width_) + size_t(x)]; };
  uint64_t marks = 0;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const Pixel& p = at(x, y);
      const bool outline = (x > 0 && at(x - 1, y).object != p.object) || (y > 0 && at(x, y - 1).object != p.object);
      put(image, x, y, outline ? kOutline : Color{p.grey, p.grey, p.grey});
      marks += p.mark != Mark::agree;
    }
  const int radius = double(marks) < kFewMarks * double(pixels_.size()) ? 3 : 0;
  for (int drawn = 1; drawn < kMarks; ++drawn)  // the worst over all others
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        if (at(x, y).mark == Mark(drawn))
          fill(image, x - radius, y - radius, 2 * radius + 1, std::min(2 * radius + 1, height_ - y + radius),
               mark_color(Mark(drawn)));
}

void CrosscheckMap::draw_sheet(const Sheet& sheet, int x0, int y0, ColorImage& image) const {
  fill(image, x0 - 1, y0 - 1, side_ + 2, side_ + 2, kOutline);
  for (int y = 0; y < side_; ++y)
    for (int x = 0; x < side_; ++x) put(image, x0 + x, y0 + y, cell_color(sheet.verdicts.at(x, y)));
  write(image, x0, y0 - 6, sheet.title);
}

std::vector<const CrosscheckMap::Sheet*> CrosscheckMap::used_sheets() const {
  std::vector<const Sheet*> used;
  for (const Sheet& sheet : sheets_)
    if (!sheet.verdicts.is_empty()) used.push_back(&sheet);
  return used;
}

ColorImage CrosscheckMap::image() const {
  const int legend_height = (kMarks + 1) * kLine + 2 * kGap;
  if (!pixels_.empty()) {
    ColorImage image = blank(std::max(width_, kLegendWidth), height_ + legend_height);
    draw_picture(image);
    draw_legend(height_ + kGap, image);
    return image;
  }
  const auto sheets = used_sheets();
  const int columns = columns_for(sheets.size()), count = int(sheets.size());
  const int step = side_ + kGap, line = step + kLine, rows = (count + columns - 1) / columns;
  ColorImage image = blank(std::max(columns * step + kGap, kLegendWidth), rows * line + kGap + legend_height);
  for (int k = 0; k < count; ++k)
    draw_sheet(*sheets[size_t(k)], kGap + k % columns * step, kGap + kLine + k / columns * line, image);
  draw_legend(rows * line + 2 * kGap, image);
  return image;
}

}  // namespace alhazen
