#include "reflectance/drawing_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "loaders/draw_text.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

constexpr int kSubrows = 4;  // of a pixel, where fills are measured

Rgb linear(const Ink& ink) {
  return {linear_from_srgb(float(ink.r) / 255), linear_from_srgb(float(ink.g) / 255),
          linear_from_srgb(float(ink.b) / 255)};
}

/// How much of each pixel of a part of the picture a shape covers.
struct Mask {
  int x0, y0, width, height;
  std::vector<float> cover;
  [[nodiscard]] float& at(int x, int y) { return cover[size_t(y - y0) * size_t(width) + size_t(x - x0)]; }
};

Mask mask_around(const std::vector<Vec2d>& points, double margin, const ColorImage& image) {
  Vec2d low = points.front(), high = points.front();
  for (const Vec2d& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const int x0 = std::max(0, int(std::floor(low.x - margin))), y0 = std::max(0, int(std::floor(low.y - margin)));
  const int x1 = std::min(image.width, int(std::ceil(high.x + margin)) + 1);
  const int y1 = std::min(image.height, int(std::ceil(high.y + margin)) + 1);
  Mask mask{x0, y0, std::max(0, x1 - x0), std::max(0, y1 - y0), {}};
  mask.cover.assign(size_t(mask.width) * size_t(mask.height), 0.0f);
  return mask;
}

/// Mixed as sRGB bytes, as browsers do.
void blend(ColorImage& image, int x, int y, const Rgb& color, double cover) {
  float* out = image.at(x, y);
  const auto mix = [&](float below, float above) {
    const float a = srgb_from_linear(below), b = srgb_from_linear(above);
    return linear_from_srgb(std::clamp(a + (b - a) * float(cover), 0.0f, 1.0f));
  };
  out[0] = mix(out[0], color.r), out[1] = mix(out[1], color.g), out[2] = mix(out[2], color.b), out[3] = 1;
}

void blend(ColorImage& image, Mask& mask, const Ink& ink) {
  const Rgb color = linear(ink);
  for (int y = mask.y0; y < mask.y0 + mask.height; ++y)
    for (int x = mask.x0; x < mask.x0 + mask.width; ++x)
      if (const float cover = mask.at(x, y); cover > 0) blend(image, x, y, color, double(cover) * ink.opacity);
}

double distance(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const Vec2d ab = b - a, ap = p - a;
  const double length2 = dot(ab, ab);
  const Vec2d off = ap - ab * (length2 > 0 ? std::clamp(dot(ap, ab) / length2, 0.0, 1.0) : 0);
  return std::sqrt(dot(off, off));
}

void stroke_segment(const Vec2d& a, const Vec2d& b, double width, Mask& mask) {
  const double reach = width / 2 + 1;
  const int x0 = std::max(mask.x0, int(std::min(a.x, b.x) - reach)),
            y0 = std::max(mask.y0, int(std::min(a.y, b.y) - reach));
  const int x1 = std::min(mask.x0 + mask.width - 1, int(std::max(a.x, b.x) + reach));
  const int y1 = std::min(mask.y0 + mask.height - 1, int(std::max(a.y, b.y) + reach));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double cover = 0.5 + width / 2 - distance({x + 0.5, y + 0.5}, a, b);
      mask.at(x, y) = std::max(mask.at(x, y), float(std::clamp(cover, 0.0, std::min(1.0, width))));
    }
}

/// Calls segment(from, to) for each piece that is drawn.
template <class Segment>
void dashes(const std::vector<Vec2d>& points, double dash, const Segment& segment) {
  double along = 0;
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec2d a = points[i], ab = points[i + 1] - a;
    const double length = std::sqrt(dot(ab, ab));
    if (!(dash > 0)) {
      segment(a, points[i + 1]);
      continue;
    }
    for (double from = 0; from < length;) {
      const double left = dash - std::fmod(along + from, dash), to = std::min(length, from + std::max(left, 1e-3));
      if (std::fmod(along + from, 2 * dash) < dash) segment(a + ab * (from / length), a + ab * (to / length));
      from = to;
    }
    along += length;
  }
}

void stroke(ColorImage& image, const std::vector<Vec2d>& points, const Outline& path, int scale) {
  const double width = path.width * scale;
  Mask mask = mask_around(points, width, image);
  dashes(points, path.dash * scale, [&](const Vec2d& a, const Vec2d& b) { stroke_segment(a, b, width, mask); });
  blend(image, mask, path.line);
}

/// Where a row meets the closed path, ascending.
std::vector<double> crossings(const std::vector<Vec2d>& points, double y) {
  std::vector<double> xs;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec2d &a = points[i], &b = points[(i + 1) % points.size()];
    if ((a.y <= y) != (b.y <= y)) xs.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
  }
  std::ranges::sort(xs);
  return xs;
}

void fill(ColorImage& image, const std::vector<Vec2d>& points, const Ink& ink) {
  Mask mask = mask_around(points, 0, image);
  for (int row = 0; row < mask.height * kSubrows; ++row) {
    const int y = mask.y0 + row / kSubrows;
    const std::vector<double> xs = crossings(points, mask.y0 + (row + 0.5) / kSubrows);
    for (size_t i = 0; i + 1 < xs.size(); i += 2)
      for (int x = std::max(mask.x0, int(xs[i])); x < mask.x0 + mask.width && x < xs[i + 1]; ++x)
        mask.at(x, y) += float((std::min(xs[i + 1], x + 1.0) - std::max(xs[i], double(x))) / kSubrows);
  }
  blend(image, mask, ink);
}

void draw(ColorImage& image, const Outline& path, int scale) {
  std::vector<Vec2d> points;
  for (const Vec2d& p : path.points) points.push_back(p * double(scale));
  if (points.size() < 2) return;
  if (path.fill.opacity > 0) fill(image, points, path.fill);
  if (path.line.opacity > 0) stroke(image, points, path, scale);
}

/// Calls text(piece) and sign() for what stands between degree signs, and for these: OpenImageIO 2.4 cannot write them.
template <class Text, class Sign>
void split_at_degrees(std::string_view words, const Text& text, const Sign& sign) {
  constexpr std::string_view kSign = "°";
  for (size_t at = 0; at <= words.size();) {
    const size_t next = words.find(kSign, at);
    if (const std::string_view piece = words.substr(at, next - at); !piece.empty()) text(std::string(piece));
    if (next == std::string_view::npos) return;
    sign();
    at = next + kSign.size();
  }
}

void draw(ColorImage& image, const Words& words, int scale) {
  const int size = int(std::lround(words.size * scale));
  const double sign_width = 0.5 * size;
  double width = 0;
  split_at_degrees(
      words.text, [&](const std::string& piece) { width += text_width(piece, size); }, [&] { width += sign_width; });
  const double before = words.anchor == Anchor::start ? 0 : words.anchor == Anchor::middle ? 0.5 : 1;
  double x = words.at.x * scale - before * width;
  const double y = words.at.y * scale;
  split_at_degrees(
      words.text,
      [&](const std::string& piece) {
        draw_text(image, int(std::lround(x)), int(std::lround(y)), piece, size, linear(words.ink));
        x += text_width(piece, size);
      },
      [&] {
        draw(image, circle({x + 0.26 * size, y - 0.6 * size}, 0.13 * size, words.ink, kNoInk, 0.06 * size), 1);
        x += sign_width;
      });
}

/// Bilinear, premultiplied; x and y in pixels, those at the edge going on beyond it.
std::array<float, 4> sampled(const ColorImage& image, double x, double y) {
  const double u = std::clamp(x - 0.5, 0.0, image.width - 1.0), v = std::clamp(y - 0.5, 0.0, image.height - 1.0);
  const int x0 = std::min(int(u), image.width - 2), y0 = std::min(int(v), image.height - 2);
  std::array<float, 4> sum{};
  for (const auto& [dx, dy] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}}) {
    const double weight = (1 - std::abs(u - x0 - dx)) * (1 - std::abs(v - y0 - dy));
    const float *in = image.at(x0 + dx, y0 + dy), alpha = float(weight) * in[3];
    for (size_t c = 0; c < 3; ++c) sum[c] += alpha * in[c];
    sum[3] += alpha;
  }
  return sum;
}

void draw(ColorImage& image, const Inset& inset, int scale) {
  const int side = int(std::lround(inset.side * scale));
  const int x0 = int(std::lround(inset.at.x * scale)), y0 = int(std::lround(inset.at.y * scale));
  const double step = double(inset.image.width) / side;
  for (int y = 0; y < side && y0 + y < image.height; ++y)
    for (int x = 0; x < side && x0 + x < image.width; ++x) {
      const auto [r, g, b, alpha] = sampled(inset.image, (x + 0.5) * step, (y + 0.5) * step);
      if (alpha > 0) blend(image, x0 + x, y0 + y, Rgb(r, g, b) * (1 / alpha), double(alpha));
    }
}

}  // namespace

ColorImage drawing_picture(const Drawing& drawing, int scale) {
  const int width = int(std::ceil(drawing.width)) * scale, height = int(std::ceil(drawing.height)) * scale;
  ColorImage image{width, height, {"R", "G", "B", "A"}, {}};
  image.pixels.assign(size_t(width) * size_t(height) * 4, 1.0f);
  for (const Mark& mark : drawing.marks) std::visit([&](const auto& m) { draw(image, m, scale); }, mark);
  return image;
}

}  // namespace alhazen
