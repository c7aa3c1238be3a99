// `alhazen crosscheck --map`: a picture of where the parties disagree, and who is right.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/image.h"
#include "crosscheck/verdict_map.h"

namespace alhazen {

/// Of a scene's camera rays: their picture in grey, disagreements marked in it. Else a sheet over (u, v) for each
/// family and kind of face. Below: what the colours mean, and how many rays of each there are.
class CrosscheckMap {
 public:
  /// `width`, `height`: of the scene's picture, 0 for families. `families`: how many will come.
  CrosscheckMap(int width, int height, size_t families);

  void add(const std::string& family, const crosscheck::Case& c);

  /// sRGB colours as scene-linear floats. Marks of a picture are larger than a pixel while they are few.
  [[nodiscard]] ColorImage image() const;

  /// Whether the legend could be written into the picture: there is a font.
  [[nodiscard]] bool has_text() const { return has_text_; }

  /// The legend as lines of text.
  [[nodiscard]] std::string legend() const;

 private:
  struct Pixel {
    crosscheck::Mark mark = crosscheck::Mark::agree;
    uint8_t grey = 255;
    uint32_t object = kNone;
  };
  struct Sheet {
    std::string title;
    crosscheck::VerdictSheet verdicts;
  };

  void add_pixel(const crosscheck::Case& c);
  void add_to_sheet(const std::string& family, const crosscheck::Case& c);
  void draw_picture(ColorImage& image) const;
  [[nodiscard]] std::vector<const Sheet*> used_sheets() const;
  void draw_sheet(const Sheet& sheet, int x0, int y0, ColorImage& image) const;
  void draw_legend(int y0, ColorImage& image) const;
  void write(ColorImage& image, int x, int y, const std::string& text) const;

  int width_, height_, side_;
  std::vector<Pixel> pixels_;
  std::vector<Sheet> sheets_;
  std::map<std::string, size_t> sheets_of_;  // by family, the first of its kinds
  std::array<uint64_t, crosscheck::kMarks> counts_{};
  uint64_t outside_ = 0;  // rays out of the domain
  uint64_t misses_ = 0;   // rays that everybody says hit nothing: nowhere on the surface
  mutable bool has_text_ = true;
};

/// The colour of a mark, as sRGB bytes.
[[nodiscard]] std::array<uint8_t, 3> mark_color(crosscheck::Mark mark);

}  // namespace alhazen
