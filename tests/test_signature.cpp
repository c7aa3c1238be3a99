// Claims about scene signatures: what is counted, and what counts as a difference.
#include <gtest/gtest.h>

#include <random>

#include "core/vec.h"
#include "inspect/legend.h"
#include "inspect/signature.h"
#include "loaders/image_file.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

IdImage random_ids(int width, int height, uint32_t seed) {
  IdImage ids{width, height, {"node", "primitive", "material"}, {}};
  std::mt19937 engine(seed);
  const auto below = [&](uint32_t n) { return uint32_t(engine() % n); };
  for (int i = 0; i < width * height; ++i) {
    const uint32_t node = below(5) == 0 ? kNone : below(7);
    ids.pixels.insert(ids.pixels.end(), {node, node == kNone ? kNone : below(3), node == kNone ? kNone : below(2)});
  }
  return ids;
}

TEST(Signature, EveryPixelIsCountedOnceAndTheBackgroundLast) {
  const IdImage ids = random_ids(37, 23, 1);
  uint64_t sum = 0;
  const auto seen = seen_nodes(ids);
  for (size_t i = 0; i < seen.size(); ++i) {
    sum += seen[i].pixels;
    if (i > 0) {
      EXPECT_LT(seen[i - 1].node, seen[i].node);
    }
    uint64_t count = 0;
    for (size_t p = 0; p < ids.pixels.size(); p += 3) count += ids.pixels[p] == seen[i].node;
    EXPECT_EQ(count, seen[i].pixels);
  }
  EXPECT_EQ(sum, 37u * 23);
  EXPECT_EQ(seen.back().node, kNone);
}

TEST(Signature, DiffersFromItselfNowhereAndFromAnotherWhereAnyChannelDoes) {
  const IdImage a = random_ids(40, 30, 2);
  EXPECT_TRUE(difference(a, a).empty());
  IdImage b = a;
  b.pixels[3 * 5] += 1, b.pixels[3 * 6 + 1] += 1, b.pixels[3 * 7 + 2] += 1, b.pixels[3 * 8] += 1,
      b.pixels[3 * 8 + 1] += 1;
  const SignatureDiff diff = difference(a, b);
  EXPECT_EQ(diff.nodes, 2u);
  EXPECT_EQ(diff.details, 2u);
  const auto marked = [&](size_t p) { return diff.picture.pixels[4 * p] == 1.0f; };
  for (size_t p = 0; p < 40 * 30; ++p) EXPECT_EQ(marked(p), p >= 5 && p <= 8) << p;
}

TEST(Signature, PictureWithALegendShowsTheColoursThatFilesHold) {
  const IdImage ids = random_ids(31, 17, 3);
  const ColorImage page = with_legend(node_picture(ids), {{Rgb(0.5f), "a", "1"}, {Rgb(0.2f), "b", "2"}});
  EXPECT_GT(page.width, ids.width);
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x) {
      const auto color = node_color(ids.at(x, y)[0]);
      for (size_t c = 0; c < 3; ++c)
        ASSERT_EQ(std::lround(255 * srgb_from_linear(page.at(x, y)[c])), color[c]) << x << " " << y;
    }
}

TEST(Signature, ALegendOfManyRowsCountsWhatHasNoRoom) {
  const ColorImage small{16, 16, {"R", "G", "B", "A"}, std::vector<float>(16 * 16 * 4, 0.5f)};
  const std::vector<LegendRow> rows(1000, {Rgb(0.5f), std::string(500, 'x'), "1"});
  const ColorImage page = with_legend(small, rows);
  EXPECT_LT(page.height, 400);
  EXPECT_EQ(with_legend(small, {}).height, 20);
}

}  // namespace
}  // namespace alhazen
