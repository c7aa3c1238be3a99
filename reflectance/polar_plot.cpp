#include "reflectance/polar_plot.h"

#include <algorithm>
#include <cmath>

#include "inspect/tree_words.h"
#include "reflectance/directions.h"
#include "reflectance/palette.h"
#include "reflectance/verdicts.h"

namespace alhazen {
namespace {

constexpr double kSteep = 12;    // from this ratio of the peak to the median on, logarithms show more
constexpr int kMostDecades = 5;  // between the centre and the rim
constexpr double kHeadroom = 1.06;

std::vector<double> luminances(std::span<const LobeSlice> slices) {
  std::vector<double> values;
  for (const LobeSlice& slice : slices)
    for (const Rgb& value : slice.values) values.push_back(double(luminance(value)));
  std::ranges::sort(values);
  return values;
}

/// 1, 2 or 5 times a power of ten, about a third of `high`.
double ring_step(double high) {
  const double power = std::pow(10, std::floor(std::log10(high / 3))), ratio = high / 3 / power;
  return power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
}

std::vector<double> ring_values(const PolarPlot& plot) {
  std::vector<double> values;
  if (plot.logarithmic)
    for (double v = plot.low * 10; v < plot.high; v *= 10) values.push_back(v);
  else
    for (double v = ring_step(plot.high); v < plot.high; v += ring_step(plot.high)) values.push_back(v);
  return values;
}

}  // namespace

double PolarPlot::distance(double value) const {
  if (!(value > low)) return 0;
  const double share = logarithmic ? std::log(value / low) / std::log(high / low) : value / high;
  return radius * std::min(share, 1.0);
}

Vec2d PolarPlot::at(double exitant, double distance) const {
  return centre + distance * Vec2d{std::sin(exitant * kDegree), -std::cos(exitant * kDegree)};
}

PolarPlot polar_plot(std::span<const LobeSlice> slices, RadialScale scale, const Vec2d& centre, double radius) {
  PolarPlot plot{centre, radius};
  const std::vector<double> values = luminances(slices);
  if (values.empty() || !(values.back() > 0)) return plot;
  const double most = values.back(), median = values[values.size() / 2];
  plot.high = most * kHeadroom;
  plot.logarithmic = scale == RadialScale::logarithmic || (scale == RadialScale::automatic && most > kSteep * median);
  if (!plot.logarithmic) return plot;
  const double lowest = std::ceil(std::log10(most)) - kMostDecades;
  plot.low = std::pow(10, median > 0 ? std::max(lowest, std::floor(std::log10(median / 3))) : lowest);
  return plot;
}

std::vector<Mark> polar_axes(const PolarPlot& plot) {
  std::vector<Mark> marks;
  const double pi = std::numbers::pi;
  for (const int degrees : {-60, -30, 0, 30, 60}) {
    marks.emplace_back(line(plot.centre, plot.at(degrees, plot.radius), kGridInk));
    marks.emplace_back(Words{plot.at(degrees, plot.radius + 17) + Vec2d{0, 4}, std::to_string(std::abs(degrees)) + "°",
                             10, kFaintInk, Anchor::middle});
  }
  for (const double value : ring_values(plot)) {
    const double r = plot.distance(value);
    marks.emplace_back(arc(plot.centre, r, 0, pi, kGridInk));
    for (const double side : {-1.0, 1.0})
      marks.emplace_back(Words{plot.centre + Vec2d{side * r, 13}, plain_number(value), 9, kFaintInk, Anchor::middle});
  }
  marks.emplace_back(arc(plot.centre, plot.radius, 0, pi, kGridInk, 1.5));
  marks.emplace_back(line(plot.at(-90, plot.radius + 12), plot.at(90, plot.radius + 12), kAxisInk, 1.5));
  return marks;
}

Outline lobe_outline(const PolarPlot& plot, const LobeSlice& slice, const Ink& ink, double width) {
  Outline path{.points = {}, .line = ink, .fill = faded(ink, 0.07), .width = width};
  for (size_t i = 0; i < slice.values.size(); ++i)
    path.points.push_back(plot.at(slice.degrees[i], plot.distance(double(luminance(slice.values[i])))));
  return path;
}

std::vector<Mark> light_arrow(const PolarPlot& plot, double incident, const Ink& ink) {
  const Vec2d tail = plot.at(-incident, plot.radius), tip = plot.at(-incident, plot.radius - 30);
  const Vec2d along = (tip - tail) * (1.0 / 30), across{-along.y, along.x};
  Outline head{
      .points = {tip, tip - along * 8.0 + across * 3.5, tip - along * 8.0 - across * 3.5}, .line = kNoInk, .fill = ink};
  return {line(tail, tip - along * 6.0, ink, 2), head};
}

}  // namespace alhazen
