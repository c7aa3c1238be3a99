#include "reflectance/sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "inspect/layer_picture.h"
#include "inspect/tree_words.h"
#include "materials/texture.h"
#include "reflectance/albedo_plot.h"
#include "reflectance/directions.h"
#include "reflectance/hemisphere_map.h"
#include "reflectance/lit_sphere.h"
#include "reflectance/palette.h"
#include "reflectance/polar_plot.h"
#include "reflectance/verdicts.h"

namespace alhazen {
namespace {

constexpr double kWidth = 1000, kLeft = 40, kRight = 960;
constexpr double kSide = 250;  // of the square pictures
constexpr double kLobesTop = 118, kRadius = 240;
constexpr Vec2d kLobesCentre{kLeft + 14 + kRadius, kLobesTop + 40 + kRadius};
constexpr double kLegendTop = kLobesCentre.y + 36, kLegendColumn = 285;
constexpr double kAlbedoLeft = 640, kAlbedoHeight = 244;
constexpr int kMapPixels = 250, kSpherePixels = 330, kLiveMapPixels = 180;
constexpr size_t kLineLetters = 132;

std::vector<std::string> wrapped(const std::string& text, size_t letters) {
  std::vector<std::string> lines{""};
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > letters) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

Ink ink_of(const Rgb& linear) {
  const auto byte = [](float v) { return uint8_t(std::lround(255 * srgb_from_linear(std::clamp(v, 0.0f, 1.0f)))); };
  return {byte(linear.r), byte(linear.g), byte(linear.b)};
}

std::string angle_text(double degrees) { return short_number(degrees) + "°"; }

class Sheet {
 public:
  /// `angles`: all that will be asked for by `at_angle`.
  Sheet(const BrdfReport& report, const std::vector<double>& angles, int map_pixels) : report_(report) {
    const Brdf& brdf = report.subject.brdf;
    std::vector<LobeSlice> all = report.slices;
    for (const double angle : angles) {
      live_.push_back(lobe_slice(brdf, angle, report.options.azimuth));
      maps_.push_back(hemisphere_map(brdf, angle, report.options.azimuth, map_pixels));
    }
    all.insert(all.end(), live_.begin(), live_.end());
    all.insert(all.end(), report.fitted.begin(), report.fitted.end());
    plot_ = polar_plot(all, report.options.scale, kLobesCentre, kRadius);
    heat_ = heat_scale(maps_);
  }

  Drawing fixed() {
    title();
    lobes();
    heading({kAlbedoLeft, kLobesTop}, "Share of the light, by its angle");
    add(albedo_plot(report_.check, {kAlbedoLeft + 26, kLobesTop + 22}, kRight - kAlbedoLeft - 26, kAlbedoHeight));
    pictures();
    laws();
    drawing_.width = kWidth, drawing_.height = y_ + 14;
    return std::move(drawing_);
  }

  /// What changes with the angle of incidence.
  [[nodiscard]] std::vector<Mark> at_angle(size_t i, bool with_lobe) const {
    std::vector<Mark> marks;
    if (with_lobe) {
      marks.emplace_back(lobe_outline(plot_, live_[i], kTextInk, 2.2));
      std::ranges::move(light_arrow(plot_, live_[i].incident, kTextInk), std::back_inserter(marks));
    }
    const Vec2d corner{kLeft, pictures_top()}, centre = corner + Vec2d{kSide / 2, kSide / 2};
    marks.emplace_back(
        Words{{kLeft, pictures_top() - 14}, "All directions, light at " + angle_text(live_[i].incident), 14, kTextInk});
    marks.emplace_back(Inset{corner, kSide, heat_picture(maps_[i], heat_)});
    for (const double theta : {30.0, 60.0, 90.0})
      marks.emplace_back(circle(centre, kSide / 2 * std::sqrt(1 - std::cos(theta * kDegree)),
                                theta < 90 ? Ink{255, 255, 255, 0.35} : kAxisInk, kNoInk));
    const Vec3f s = slice_light(live_[i].incident, report_.options.azimuth);
    const auto place = [&](const Vec3f& d) {
      const Vec2d p = disk_of_direction(d);
      return centre + Vec2d{-p.x, p.y} * (kSide / 2);
    };
    marks.emplace_back(circle(place(mirrored(s)), 7, {255, 255, 255}, kNoInk, 1.6));
    marks.emplace_back(circle(place(s), 5, {255, 255, 255}, {250, 190, 40}, 1.6));
    return marks;
  }

 private:
  [[nodiscard]] bool has_lobe() const {
    return std::ranges::any_of(report_.slices, [](const LobeSlice& slice) { return peak(slice) > 0; });
  }
  [[nodiscard]] double pictures_top() const {
    return kLegendTop + double((report_.slices.size() + report_.fit.has_value() + 1) / 2) * 18 + 52;
  }

  void add(std::vector<Mark> marks) { std::ranges::move(marks, std::back_inserter(drawing_.marks)); }
  void words(const Vec2d& at, const std::string& text, double size, const Ink& ink) {
    drawing_.marks.emplace_back(Words{at, text, size, ink});
  }
  void heading(const Vec2d& at, const std::string& text) { words(at, text, 14, kTextInk); }

  void title() {
    const Subject& subject = report_.subject;
    words({kLeft, 48}, subject.name.empty() ? subject.model : subject.name, 24, kTextInk);
    const std::string settings = settings_text(subject);
    const std::string facts =
        subject.name.empty() ? settings : subject.model + (settings.empty() ? "" : ": ") + settings;
    double y = 72;
    for (const std::string& line : wrapped(facts, kLineLetters)) words({kLeft, y}, line, 12, kFaintInk), y += 16;
  }

  /// The peak of a slice, and where the light goes on as rays, their shares.
  [[nodiscard]] std::string facts(const LobeSlice& slice) const {
    std::string text;
    if (const double most = double(peak(slice)); most > 0) text = "peak " + plain_number(most) + "/sr";
    if (!report_.subject.smooth) return text.empty() ? "nothing" : text;
    const RayShares rays = report_.subject.smooth(float(std::cos(slice.incident * kDegree)));
    char shares[48];
    std::snprintf(shares, sizeof shares, "R %.2f, T %.2f", double(luminance(rays.mirrored)),
                  double(luminance(rays.transmitted)));
    return text + (text.empty() ? "" : ", ") + shares;
  }

  void lobes() {
    heading({kLeft, kLobesTop}, "Lobes in the plane of incidence");
    words({kLeft + 248, kLobesTop}, plot_.logarithmic ? "1/sr, logarithmic" : "1/sr", 11, kFaintInk);
    add(polar_axes(plot_));
    if (!has_lobe())
      drawing_.marks.emplace_back(Words{plot_.at(0, kRadius / 2),
                                        report_.subject.smooth ? "no lobe: rays alone" : "no lobe: it is black", 13,
                                        kFaintInk, Anchor::middle});
    for (size_t i = 0; i < report_.slices.size(); ++i) {
      const LobeSlice& slice = report_.slices[i];
      drawing_.marks.emplace_back(lobe_outline(plot_, slice, curve_ink(i), 2));
      add(light_arrow(plot_, slice.incident, curve_ink(i)));
      const Vec2d at{kLeft + double(i % 2) * kLegendColumn, kLegendTop + double(i / 2) * 18};
      drawing_.marks.emplace_back(line(at - Vec2d{0, 4}, at + Vec2d{22, -4}, curve_ink(i), 3));
      words(at + Vec2d{30, 0}, "light at " + angle_text(slice.incident) + ": " + facts(slice), 11, kTextInk);
    }
    fitted_lobes();
  }

  void fitted_lobes() {
    constexpr double kDash = 5;
    const size_t n = report_.fitted.size();
    for (size_t i = 0; i < n; ++i) {
      Outline lobe = lobe_outline(plot_, report_.fitted[i], curve_ink(i), 1.6);
      lobe.dash = kDash, lobe.fill = kNoInk;
      drawing_.marks.emplace_back(std::move(lobe));
    }
    if (n == 0) return;
    const Vec2d at{kLeft + double(n % 2) * kLegendColumn, kLegendTop + double(n / 2) * 18};
    drawing_.marks.emplace_back(line(at - Vec2d{0, 4}, at + Vec2d{22, -4}, kTextInk, 1.6, kDash));
    words(at + Vec2d{30, 0}, "as fitted", 11, kTextInk);
  }

  void heat_legend(const Vec2d& corner) {
    constexpr int kSteps = 64;
    const double height = kSide - 40;
    for (int i = 0; i < kSteps; ++i)
      drawing_.marks.emplace_back(filled_box(corner + Vec2d{0, height * i / kSteps}, 14, height / kSteps + 0.6,
                                             ink_of(heat_color(1 - (float(i) + 0.5f) / kSteps))));
    for (int decade = heat_.lowest; decade <= heat_.highest; ++decade) {
      const double y = corner.y + height * (heat_.highest - decade) / (heat_.highest - heat_.lowest);
      drawing_.marks.emplace_back(line({corner.x + 14, y}, {corner.x + 18, y}, kAxisInk));
      words({corner.x + 22, y + 4}, plain_number(std::pow(10, decade)), 10, kFaintInk);
    }
    words({corner.x, corner.y + height + 18}, "1/sr", 10, kFaintInk);
  }

  void pictures() {
    const double top = pictures_top(), lit = 400, furnace = kRight - kSide;
    heat_legend({kLeft + kSide + 14, top + 10});
    drawing_.marks.emplace_back(circle({kLeft + 6, top + kSide + 18}, 4.5, kAxisInk, {250, 190, 40}));
    words({kLeft + 16, top + kSide + 22}, "light", 11, kFaintInk);
    drawing_.marks.emplace_back(circle({kLeft + 66, top + kSide + 18}, 5, kAxisInk, kNoInk, 1.5));
    words({kLeft + 77, top + kSide + 22}, "mirror direction", 11, kFaintInk);
    heading({lit, top - 14}, "On a ball");
    drawing_.marks.emplace_back(Inset{{lit, top}, kSide, lit_sphere(report_.subject, report_.check, kSpherePixels)});
    const std::string rest = report_.subject.smooth ? ", without rays" : "";
    words({lit, top + kSide + 22}, "a lamp, and a faint even sky" + rest, 11, kFaintInk);
    heading({furnace, top - 14}, "In a white furnace");
    drawing_.marks.emplace_back(Inset{{furnace, top}, kSide, furnace_sphere(report_.check, kSpherePixels)});
    words({furnace, top + kSide + 22}, "brighter than around it: gains light" + rest, 11, kFaintInk);
    y_ = top + kSide + 60;
  }

  void sign(bool kept) {
    const auto stroke = [&](std::vector<Vec2d> points) {
      for (Vec2d& p : points) p = p + Vec2d{kLeft, y_};
      drawing_.marks.emplace_back(
          Outline{.points = std::move(points), .line = kept ? kGoodInk : kBadInk, .width = 2.2});
    };
    if (kept) return stroke({{0, -5}, {4, -1}, {11, -10}});  // a tick, else a cross
    stroke({{1, -9}, {10, 0}}), stroke({{1, 0}, {10, -9}});
  }

  void lines(double x, const std::string& text, const Ink& ink) {
    for (const std::string& line : wrapped(text, kLineLetters - size_t((x - kLeft) / 7)))
      words({x, y_}, line, 12, ink), y_ += 17;
  }

  void laws() {
    words({kLeft, y_}, summary(report_.check), 14, report_.check.keeps_all() ? kGoodInk : kBadInk);
    y_ += 24;
    for (const Verdict& verdict : verdicts(report_.subject, report_.check)) {
      sign(verdict.kept);
      words({kLeft + 22, y_}, verdict.law, 12, kTextInk);
      lines(kLeft + 104, verdict.finding, kTextInk);
      y_ += 3;
    }
    y_ += 4;
    for (const std::string& note : report_.subject.notes) lines(kLeft, note, kFaintInk);
    if (report_.fit) lines(kLeft, "Fitted " + fit_summary(*report_.fit) + ".", kTextInk);
  }

  const BrdfReport& report_;
  std::vector<LobeSlice> live_;
  std::vector<HemisphereMap> maps_;
  PolarPlot plot_;
  HeatScale heat_;
  Drawing drawing_;
  double y_ = 0;
};

}  // namespace

Drawing brdf_sheet(const BrdfReport& report) {
  const std::vector<double>& angles = report.options.incident;
  Sheet sheet(report, {angles[angles.size() / 2]}, kMapPixels);
  Drawing drawing = sheet.fixed();
  std::ranges::move(sheet.at_angle(0, false), std::back_inserter(drawing.marks));
  return drawing;
}

LiveSheet live_sheet(const BrdfReport& report, const std::vector<double>& angles) {
  Sheet sheet(report, angles, kLiveMapPixels);
  LiveSheet live{sheet.fixed(), {}};
  for (size_t i = 0; i < angles.size(); ++i) live.by_angle.push_back(sheet.at_angle(i, true));
  return live;
}

}  // namespace alhazen
