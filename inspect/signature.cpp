#include "inspect/signature.h"

#include <algorithm>
#include <map>

#include "core/vec.h"
#include "loaders/image_file.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

constexpr Rgb kOtherNode{1, 0.02f, 0.02f}, kOtherDetail{1, 0.75f, 0};
constexpr float kFaded = 0.15f;

void set(ColorImage& picture, size_t pixel, const Rgb& c) {
  float* out = &picture.pixels[4 * pixel];
  out[0] = c.r, out[1] = c.g, out[2] = c.b, out[3] = 1;
}

ColorImage blank(const IdImage& ids) {
  ColorImage picture{ids.width, ids.height, {"R", "G", "B", "A"}, {}};
  picture.pixels.resize(size_t(ids.width) * size_t(ids.height) * 4);
  return picture;
}

size_t pixel_count(const IdImage& ids) { return ids.pixels.size() / 3; }

}  // namespace

Rgb linear_node_color(uint32_t node) noexcept {
  const auto bytes = node_color(node);
  const auto linear = [&](size_t c) { return linear_from_srgb(float(bytes[c]) / 255); };
  return {linear(0), linear(1), linear(2)};
}

std::vector<SeenNode> seen_nodes(const IdImage& ids) {
  std::map<uint32_t, uint64_t> counts;  // kNone is the largest
  for (size_t i = 0; i < pixel_count(ids); ++i) ++counts[ids.pixels[3 * i]];
  std::vector<SeenNode> seen;
  for (const auto& [node, pixels] : counts) seen.push_back({node, pixels});
  return seen;
}

SignatureDiff difference(const IdImage& ids, const IdImage& other) {
  SignatureDiff diff{.picture = blank(ids)};
  for (size_t i = 0; i < pixel_count(ids); ++i) {
    const uint32_t *a = &ids.pixels[3 * i], *b = &other.pixels[3 * i];
    const bool same_node = a[0] == b[0], same = std::equal(a, a + 3, b);
    diff.nodes += !same_node, diff.details += same_node && !same;
    set(diff.picture, i, same ? linear_node_color(a[0]) * kFaded : same_node ? kOtherDetail : kOtherNode);
  }
  return diff;
}

ColorImage node_picture(const IdImage& ids) {
  ColorImage picture = blank(ids);
  for (size_t i = 0; i < pixel_count(ids); ++i) set(picture, i, linear_node_color(ids.pixels[3 * i]));
  return picture;
}

}  // namespace alhazen
