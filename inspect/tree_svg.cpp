#include "inspect/tree_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include "inspect/labels.h"
#include "inspect/tree_words.h"
#include "inspect/xml.h"

namespace alhazen {
namespace {

constexpr size_t kMostRays = 31;
constexpr double kBoxWidth = 176, kBoxHeight = 50, kColumn = 236, kRow = 60, kMargin = 16, kTop = 64, kBottom = 34;
constexpr double kWidestBranch = 16, kThinnestBranch = 1;

// By RayKind, then total internal reflection.
constexpr std::array kKindColors{"#8a8f98", "#4c8dd6", "#2fa58a", "#8a8f98", "#b06fd0"};
constexpr std::array kKindNames{"camera", "mirror", "refracted", "straight on", "total internal reflection"};

size_t kind_index(const TreeRay& ray) { return ray.total ? 4 : size_t(ray.kind); }

struct Box {
  uint32_t ray;     // kNone: stands for the rays that are not drawn
  uint32_t parent;  // index of its box, kNone for the root
  int column;
  double row = 0;     // of its middle
  size_t folded = 0;  // rays that it stands for
  Rgb folded_light{};
};

std::string num(double v) { return short_decimal(v); }

class TreeSvg {
 public:
  TreeSvg(const Scene& scene, const RayTree& tree)
      : scene_(scene), tree_(tree), children_(children(tree)), branch_(branch_light(tree)) {}

  std::string text() {
    choose();
    if (!tree_.rays.empty()) place(0, kNone, 0);
    frame();
    for (const Box& box : boxes_) draw_branch(box);
    for (const Box& box : boxes_) draw_box(box);
    return std::move(out_) + "</svg>\n";
  }

 private:
  /// The rays that bring most, each after its parent.
  void choose() {
    drawn_.assign(tree_.rays.size(), false);
    const auto less = [&](uint32_t a, uint32_t b) { return luminance(branch_[a]) < luminance(branch_[b]); };
    std::priority_queue<uint32_t, std::vector<uint32_t>, decltype(less)> next(less);
    if (!tree_.rays.empty()) next.push(0);
    for (size_t count = 0; count < kMostRays && !next.empty(); ++count) {
      const uint32_t ray = next.top();
      next.pop();
      drawn_[ray] = true;
      for (const uint32_t child : children_[ray]) next.push(child);
    }
  }

  [[nodiscard]] size_t size_of(uint32_t ray) const {
    size_t size = 1;
    for (const uint32_t child : children_[ray]) size += size_of(child);
    return size;
  }

  /// Leaves take rows in their order, others the middle of their branches.
  uint32_t place(uint32_t ray, uint32_t parent, int column) {
    const auto index = uint32_t(boxes_.size());
    boxes_.push_back({ray, parent, column});
    columns_ = std::max(columns_, column + 1);
    Box rest{kNone, index, column + 1};
    std::vector<uint32_t> placed;
    for (const uint32_t child : children_[ray]) {
      if (drawn_[child])
        placed.push_back(place(child, index, column + 1));
      else
        rest.folded += size_of(child), rest.folded_light += branch_[child];
    }
    if (rest.folded > 0) {
      rest.row = rows_++;
      columns_ = std::max(columns_, column + 2);
      placed.push_back(uint32_t(boxes_.size()));
      boxes_.push_back(rest);
    }
    boxes_[index].row = placed.empty() ? rows_++ : (boxes_[placed.front()].row + boxes_[placed.back()].row) / 2;
    return index;
  }

  [[nodiscard]] static double left(const Box& box) { return kMargin + box.column * kColumn; }
  [[nodiscard]] static double middle(const Box& box) { return kTop + (box.row + 0.5) * kRow; }

  void frame() {
    const double width = std::max(2 * kMargin + (columns_ - 1) * kColumn + kBoxWidth, 640.0);
    const double height = kTop + std::max(1.0, rows_) * kRow + kBottom;
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + num(width) + "\" height=\"" + num(height) +
           "\" viewBox=\"0 0 " + num(width) + " " + num(height) +
           "\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"11\">\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#17181c\"/>\n";
    swatch(kMargin, 16, 28, tree_.radiance);
    words(kMargin + 38, 29,
          "pixel " + std::to_string(tree_.x) + ", " + std::to_string(tree_.y) + " of " + std::to_string(tree_.width) +
              " × " + std::to_string(tree_.height),
          "#f0f0f0", 15);
    words(kMargin + 38, 44,
          (tree_.samples > 1 ? "sample " + std::to_string(tree_.sample) + ": " : "") + short_color(tree_.radiance) +
              ", of " + std::to_string(tree_.rays.size()) + (tree_.rays.size() == 1 ? " ray" : " rays"),
          "#a0a4ac", 11);
    double x = kMargin;
    for (size_t k = 1; k < kKindNames.size(); ++k) {
      out_ += "<line x1=\"" + num(x) + "\" y1=\"" + num(height - 16) + "\" x2=\"" + num(x + 18) + "\" y2=\"" +
              num(height - 16) + "\" stroke=\"" + kKindColors[k] + "\" stroke-width=\"5\"/>\n";
      words(x + 24, height - 12, kKindNames[k], "#a0a4ac", 11);
      x += 44 + 6.6 * double(std::string(kKindNames[k]).size());
    }
  }

  void words(double x, double y, const std::string& text, const char* color, int size) {
    out_ += "<text x=\"" + num(x) + "\" y=\"" + num(y) + "\" fill=\"" + color + "\" font-size=\"" +
            std::to_string(size) + "\">" + xml_escaped(text) + "</text>\n";
  }

  void swatch(double x, double y, double size, const Rgb& light) {
    out_ += "<rect x=\"" + num(x) + "\" y=\"" + num(y) + "\" width=\"" + num(size) + "\" height=\"" + num(size) +
            "\" rx=\"2\" fill=\"" + hex_color(light) + "\" stroke=\"#5a5e66\" stroke-width=\"0.5\"/>\n";
  }

  [[nodiscard]] double width_of(const Box& box) const {
    const double weight = box.ray == kNone ? 0 : double(max_component(tree_.rays[box.ray].weight));
    return kThinnestBranch + (kWidestBranch - kThinnestBranch) * std::clamp(weight, 0.0, 1.0);
  }

  void draw_branch(const Box& box) {
    if (box.parent == kNone) return;
    const Box& from = boxes_[box.parent];
    const double x0 = left(from) + kBoxWidth, x1 = left(box), bend = (x0 + x1) / 2;
    const char* color = box.ray == kNone ? "#4a4d55" : kKindColors[kind_index(tree_.rays[box.ray])];
    out_ += "<path d=\"M" + num(x0) + " " + num(middle(from)) + " C" + num(bend) + " " + num(middle(from)) + " " +
            num(bend) + " " + num(middle(box)) + " " + num(x1) + " " + num(middle(box)) + "\" fill=\"none\" stroke=\"" +
            color + "\" stroke-opacity=\"0.85\" stroke-width=\"" + num(width_of(box)) + "\"" +
            (box.ray == kNone ? " stroke-dasharray=\"4 3\"" : "") + "/>\n";
  }

  /// Of the pixel's light, in percent.
  [[nodiscard]] std::string share(const Rgb& light) const {
    const float all = luminance(tree_.radiance);
    return all > 0 ? short_number(100 * double(luminance(light) / all)) + " %" : "0 %";
  }

  void draw_box(const Box& box) {
    const double x = left(box), y = middle(box) - kBoxHeight / 2;
    if (box.ray == kNone) {
      swatch(x + 2, y + 17, 16, box.folded_light);
      return words(
          x + 26, y + 29,
          "+ " + std::to_string(box.folded) + (box.folded == 1 ? " ray, " : " rays, ") + share(box.folded_light),
          "#a0a4ac", 11);
    }
    const TreeRay& ray = tree_.rays[box.ray];
    const bool traced = ray.end != RayEnd::depth_limit && ray.end != RayEnd::weight_limit;
    out_ += "<g class=\"ray\" data-ray=\"" + std::to_string(box.ray) + "\"><title>" +
            xml_escaped(kind_text(ray) + ", weight " + short_color(ray.weight)) + "</title>\n<rect x=\"" + num(x) +
            "\" y=\"" + num(y) + "\" width=\"" + num(kBoxWidth) + "\" height=\"" + num(kBoxHeight) +
            "\" rx=\"5\" fill=\"#24262c\" stroke=\"" + kKindColors[kind_index(ray)] + "\"" +
            (traced ? "" : " stroke-dasharray=\"4 3\"") + "/>\n";
    swatch(x + 7, y + 8, 34, branch_[box.ray]);
    swatch(x + 29, y + 30, 12, own_light(ray));
    words(x + 49, y + 17, fitted(target_text(scene_, ray), 19), "#f0f0f0", 11);
    words(x + 49, y + 31, second_line(ray), "#a0a4ac", 10);
    words(x + 49, y + 43, "w " + short_number(double(max_component(ray.weight))) + ", " + share(branch_[box.ray]),
          "#a0a4ac", 10);
    out_ += "</g>\n";
  }

  [[nodiscard]] std::string second_line(const TreeRay& ray) const {
    if (!ray.hit) return ray.end == RayEnd::missed ? "leaves the scene" : "not traced";
    if (ray.interface && ray.interface->ior_before != ray.interface->ior_after) {
      const Interface& i = *ray.interface;
      return "n " + short_number(double(i.ior_before.g)) + "→" + short_number(double(i.ior_after.g)) + "  " +
             std::to_string(std::lround(incident_degrees(ray))) + "°" +
             (i.total ? " total" : "→" + std::to_string(std::lround(refracted_degrees(ray))) + "°");
    }
    return fitted(material_label(scene_, ray.hit->material) + ", " + short_number(double(ray.hit->distance)) + " m",
                  21);
  }

  /// Cut between characters of UTF-8.
  static std::string fitted(const std::string& text, size_t room) {
    if (text.size() <= room) return text;
    size_t end = room - 1;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "…";
  }

  const Scene& scene_;
  const RayTree& tree_;
  std::vector<std::vector<uint32_t>> children_;
  std::vector<Rgb> branch_;
  std::vector<bool> drawn_;
  std::vector<Box> boxes_;
  double rows_ = 0;
  int columns_ = 1;
  std::string out_;
};

}  // namespace

std::string tree_svg(const Scene& scene, const RayTree& tree) { return TreeSvg(scene, tree).text(); }

}  // namespace alhazen
