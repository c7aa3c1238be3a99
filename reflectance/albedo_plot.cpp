#include "reflectance/albedo_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "inspect/tree_words.h"
#include "reflectance/palette.h"

namespace alhazen {
namespace {

constexpr Ink kRed{196, 52, 44}, kGreen{40, 140, 70}, kBlue{40, 96, 190}, kMirror{120, 80, 180}, kThrough{0, 140, 150};
constexpr double kVisible = 0.01;  // of 1: what differs by less is one curve
constexpr double kHighest = 4;     // the curves leave the box above

struct Curve {
  std::string name;  // empty: shares the last one's
  Ink ink;
  double dash;
  std::vector<double> values;  // by angle
};

using ValueAt = std::function<double(const AlbedoAtAngle&)>;

std::vector<double> values_of(const BrdfCheck& check, const ValueAt& value) {
  std::vector<double> values;
  for (const AlbedoAtAngle& at : check.albedo) values.push_back(value(at));
  return values;
}

bool differ(const std::vector<double>& a, const std::vector<double>& b) {
  for (size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > kVisible) return true;
  return false;
}

double most(const std::vector<double>& values) { return *std::ranges::max_element(values); }

/// Red, green and blue, or one where they look the same.
void add_colors(const BrdfCheck& check, const std::string& name, double dash,
                const std::function<Rgb(const AlbedoAtAngle&)>& color, std::vector<Curve>& curves) {
  const auto r = values_of(check, [&](const auto& at) { return double(color(at).r); });
  const auto g = values_of(check, [&](const auto& at) { return double(color(at).g); });
  const auto b = values_of(check, [&](const auto& at) { return double(color(at).b); });
  if (!differ(r, g) && !differ(g, b)) return curves.push_back({name, kTextInk, dash, g});
  curves.push_back({name, kRed, dash, r}), curves.push_back({"", kGreen, dash, g}),
      curves.push_back({"", kBlue, dash, b});
}

std::vector<Curve> curves_of(const BrdfCheck& check) {
  std::vector<Curve> curves;
  add_colors(
      check, "beam reflected", 0, [](const auto& at) { return at.beam.value; }, curves);
  const auto beam = values_of(check, [](const auto& at) { return double(luminance(at.beam.value)); });
  const auto furnace = values_of(check, [](const auto& at) { return double(luminance(at.furnace.value)); });
  if (differ(beam, furnace))
    add_colors(
        check, "in a white furnace", 4, [](const auto& at) { return at.furnace.value; }, curves);
  const auto mirror = values_of(check, [](const auto& at) { return double(luminance(at.rays.mirrored)); });
  const auto through = values_of(check, [](const auto& at) { return double(luminance(at.rays.transmitted)); });
  if (most(mirror) > 0) curves.push_back({"R: mirror ray", kMirror, 0, mirror});
  if (most(through) > 0) curves.push_back({"T: refracted ray", kThrough, 0, through});
  return curves;
}

struct PlotBox {
  Vec2d corner;
  double width, height, top;  // top: the value at the upper edge
  [[nodiscard]] Vec2d at(double degrees, double value) const {
    return {corner.x + width * degrees / 90, corner.y + height * (1 - value / top)};
  }
};

/// The curve's pieces within the box.
std::vector<Mark> curve_marks(const BrdfCheck& check, const Curve& curve, const PlotBox& box) {
  std::vector<Mark> marks;
  Outline path{.points = {}, .line = curve.ink, .width = 2, .dash = curve.dash};
  for (size_t i = 0; i < curve.values.size(); ++i) {
    const double angle = check.albedo[i].degrees, value = curve.values[i];
    const bool inside = value <= box.top;
    if (i > 0 && inside != (curve.values[i - 1] <= box.top)) {
      const double before = curve.values[i - 1], share = (box.top - before) / (value - before);
      path.points.push_back(box.at(check.albedo[i - 1].degrees * (1 - share) + angle * share, box.top));
    }
    if (inside) path.points.push_back(box.at(angle, value));
    if (!inside && path.points.size() > 1) marks.emplace_back(path);
    if (!inside) path.points.clear();
  }
  if (path.points.size() > 1) marks.emplace_back(path);
  return marks;
}

std::vector<Mark> axes(const PlotBox& box) {
  std::vector<Mark> marks;
  if (box.top > 1)
    marks.emplace_back(
        filled_box(box.at(0, box.top), box.width, box.at(0, 1).y - box.at(0, box.top).y, faded(kBadInk, 0.08)));
  const double step = box.top > 2.2 ? 1 : box.top > 1.3 ? 0.5 : 0.25;
  for (double value = 0; value <= box.top; value += step) {
    marks.emplace_back(line(box.at(0, value), box.at(90, value), kGridInk));
    marks.emplace_back(Words{box.at(0, value) + Vec2d{-8, 4}, short_number(value), 10, kFaintInk, Anchor::end});
  }
  for (int degrees = 0; degrees <= 90; degrees += 15) {
    marks.emplace_back(line(box.at(degrees, 0), box.at(degrees, box.top), kGridInk));
    if (degrees % 30 == 0)
      marks.emplace_back(
          Words{box.at(degrees, 0) + Vec2d{0, 15}, std::to_string(degrees) + "°", 10, kFaintInk, Anchor::middle});
  }
  marks.emplace_back(line(box.at(0, 0), box.at(90, 0), kAxisInk, 1.5));
  marks.emplace_back(line(box.at(0, 1), box.at(90, 1), faded(kBadInk, 0.7), 1));
  return marks;
}

/// A line for each name, in the inks of all curves that share it.
std::vector<Mark> legend(const std::vector<Curve>& curves, const Vec2d& corner) {
  constexpr double kSample = 24, kRow = 17;
  std::vector<Mark> marks;
  Vec2d at = corner;
  for (size_t first = 0, end; first < curves.size(); first = end, at.y += kRow) {
    for (end = first + 1; end < curves.size() && curves[end].name.empty();) ++end;
    const Vec2d step{kSample / double(end - first), 0};
    Vec2d from = at - Vec2d{0, 4};
    for (size_t i = first; i < end; ++i, from = from + step)
      marks.emplace_back(line(from, from + step, curves[i].ink, 2, curves[i].dash));
    marks.emplace_back(Words{at + Vec2d{kSample + 8, 0}, curves[first].name, 11, kTextInk});
  }
  return marks;
}

}  // namespace

std::vector<Mark> albedo_plot(const BrdfCheck& check, const Vec2d& corner, double width, double height) {
  const std::vector<Curve> curves = curves_of(check);
  double highest = 1;
  for (const Curve& curve : curves) highest = std::max(highest, most(curve.values));
  const PlotBox box{corner, width, height, std::clamp(highest * 1.05, 1.12, kHighest)};
  std::vector<Mark> marks = axes(box);
  for (const Curve& curve : curves) std::ranges::move(curve_marks(check, curve, box), std::back_inserter(marks));
  std::ranges::move(legend(curves, corner + Vec2d{0, height + 36}), std::back_inserter(marks));
  return marks;
}

}  // namespace alhazen
