#include "apps/bench_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "apps/sample_statistics.h"
#include "inspect/xml.h"

namespace alhazen {
namespace {

constexpr double kWidth = 860, kLeft = 190, kRight = 60, kTop = 84;  // of the drawing and its margins, in pixels
constexpr double kBar = 13, kScenePadding = 12, kChartHeight = 300;

/// Colours that the colour-blind tell apart (M. Okabe, K. Ito, Color Universal Design, 2008).
struct Series {
  const char *name, *title, *colour;
};
constexpr Series kFrame{"frame", "whole frame", "#000000"};
constexpr std::array<Series, kWaveKinds> kKinds{{{"camera", "Embree alone: camera", "#0072b2"},
                                                 {"camera_shadow", "their shadow rays", "#56b4e9"},
                                                 {"bounced", "bounced", "#d55e00"},
                                                 {"bounced_shadow", "their shadow rays", "#e69f00"}}};
constexpr std::array kLineColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  std::array<char, 400> text;
  std::snprintf(text.data(), text.size(), pattern, arguments...);
  return text.data();
}

std::string label(double x, double y, const char* anchor, const std::string& text) {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor) + xml_escaped(text) + "</text>\n";
}

std::string rule(double x1, double y1, double x2, double y2, const char* colour) {
  return format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x1, y1, x2, y2, colour);
}

/// 1, 2 or 5 times a power of ten: about a fifth of `largest`.
double tick_step(double largest) {
  const double power = std::pow(10, std::floor(std::log10(largest / 5)));
  const double ratio = largest / 5 / power;
  return power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
}

struct Bar {
  const Series* series;
  double mrays;  // a second
};

struct Group {
  std::string scene;
  std::vector<Bar> bars;
};

Group group_of(const FrameBench& bench) {
  Group group{bench.scene, {{&kFrame, 1e-6 * double(bench.rays.all()) / median(bench.frame_s)}}};
  for (size_t k = 0; k < kWaveKinds; ++k)
    if (const BareKind& kind = bench.bare[k]; kind.rays > 0 && kind.seconds > 0)
      group.bars.push_back({&kKinds[k], 1e-6 * double(kind.rays) * bench.threads / kind.seconds});
  return group;
}

int most_threads(const std::vector<FrameBench>& benches) {
  int most = 0;
  for (const FrameBench& bench : benches) most = std::max(most, bench.threads);
  return most;
}

std::string legend(double y) {
  std::string svg;
  double x = kLeft;
  const auto entry = [&](const Series& series) {
    svg += format("<rect x=\"%.1f\" y=\"%.1f\" width=\"10\" height=\"10\" fill=\"%s\"/>\n", x, y - 9, series.colour);
    svg += label(x + 14, y, "start", series.title);
    x += 40 + 6.3 * double(std::string(series.title).size());
  };
  entry(kFrame);
  for (const Series& kind : kKinds) entry(kind);
  return svg;
}

/// The bars from `y` on, which is moved below them.
std::string bars_svg(const std::vector<Group>& groups, double& y) {
  double largest = 1e-3, height = 0;
  for (const Group& group : groups) {
    height += double(group.bars.size()) * kBar + kScenePadding;
    for (const Bar& bar : group.bars) largest = std::max(largest, bar.mrays);
  }
  const double scale = (kWidth - kLeft - kRight) / largest, bottom = y + height;
  std::string svg;
  for (double tick = 0; tick <= largest; tick += tick_step(largest)) {
    svg += rule(kLeft + tick * scale, y, kLeft + tick * scale, bottom, "#ddd");
    svg += label(kLeft + tick * scale, bottom + 14, "middle", format("%g", tick));
  }
  for (const Group& group : groups) {
    y += kScenePadding / 2;
    svg += label(kLeft - 8, y + double(group.bars.size()) * kBar / 2 + 4, "end", group.scene);
    for (const Bar& bar : group.bars) {
      svg += format("<rect class=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"%.2f\" height=\"%.1f\" fill=\"%s\"/>\n",
                    bar.series->name, kLeft, y + 1, bar.mrays * scale, kBar - 2, bar.series->colour);
      svg += label(kLeft + bar.mrays * scale + 4, y + kBar - 3, "start", format("%.1f", bar.mrays));
      y += kBar;
    }
    y += kScenePadding / 2;
  }
  y = bottom + 14;
  return svg;
}

struct Line {
  std::string scene;
  std::vector<const FrameBench*> points;  // ascending threads
};

std::vector<Line> scaling_lines(const std::vector<FrameBench>& benches) {
  std::vector<Line> lines;
  for (const FrameBench& bench : benches) {
    const auto same = [&](const Line& line) { return line.scene == bench.scene; };
    auto found = std::ranges::find_if(lines, same);
    if (found == lines.end()) found = lines.insert(found, {bench.scene, {}});
    found->points.push_back(&bench);
  }
  std::erase_if(lines, [](const Line& line) { return line.points.size() < 2; });
  for (Line& line : lines) std::ranges::stable_sort(line.points, {}, &FrameBench::threads);
  return lines;
}

/// The lines from `y` on, which is moved below them.
std::string scaling_svg(const std::vector<Line>& lines, int most, double& y) {
  const double side = kChartHeight, bottom = y + side;
  const auto x_of = [&](double threads) { return kLeft + threads / most * side; };
  const auto y_of = [&](double times) { return bottom - times / most * side; };
  std::string svg;
  const double step = std::max(1.0, tick_step(most));
  for (double tick = 0; tick <= most; tick += step) {
    svg += rule(kLeft, y_of(tick), kLeft + side, y_of(tick), "#ddd") + rule(x_of(tick), y, x_of(tick), bottom, "#ddd");
    svg += label(kLeft - 8, y_of(tick) + 4, "end", format("%g", tick)) +
           label(x_of(tick), bottom + 16, "middle", format("%g", tick));
  }
  svg += rule(x_of(0), y_of(0), x_of(most), y_of(most), "#999");
  for (size_t k = 0; k < lines.size(); ++k) {
    const Line& line = lines[k];
    const char* colour = kLineColours[k % kLineColours.size()];
    const FrameBench& first = *line.points.front();
    std::string points;
    for (const FrameBench* p : line.points) {
      const double times = first.threads * median(first.frame_s) / median(p->frame_s);
      points += format("%.1f,%.1f ", x_of(p->threads), y_of(times));
    }
    svg += format("<polyline class=\"scaling\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\" points=\"", colour) +
           points + "\"/>\n";
    const double at = y + 14 * double(k);
    svg += rule(kLeft + side + 16, at, kLeft + side + 36, at, colour);
    svg += label(kLeft + side + 42, at + 4, "start", line.scene);
  }
  y = std::max(bottom + 20, y + 14 * double(lines.size()));
  return svg;
}

}  // namespace

std::string bench_svg(const std::vector<FrameBench>& benches) {
  const int most = most_threads(benches);
  std::vector<Group> groups;
  for (const FrameBench& bench : benches)
    if (bench.threads == most) groups.push_back(group_of(bench));
  double y = kTop;
  std::string body =
      label(kLeft, 24, "start", format("Millions of rays a second, %d thread%s", most, most == 1 ? "" : "s"));
  body += legend(52) + bars_svg(groups, y);
  if (const std::vector<Line> lines = scaling_lines(benches); !lines.empty()) {
    y += 50;
    body += label(kLeft, y - 14, "start", "Threads, and how many times as fast as one");
    body += scaling_svg(lines, most, y);
  }
  return format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\" "
             "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
             kWidth, y + 24, kWidth, y + 24) +
         body + "</svg>\n";
}

}  // namespace alhazen
