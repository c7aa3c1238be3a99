// Claims about scene signatures: what is counted, and what counts as a difference.
#include <gtest/gtest.h>

#include <random>

#include "core/vec.h"
#include "inspect/legend.h"
#include "inspect/signature.h"
#include "loaders/image_file.h"
#include "materials/texture.h"
#include "renderer/surface_ids.h"
#include "tests/uniform.h"

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

TEST(Signature, IdsOfLanesAreThoseOfEachHit) {
  using U = UintOf<ShadingLanes>;
  constexpr uint32_t kTriangles = 50, kObjects = 6;
  Uniform uniform(4);
  Scene scene;
  scene.materials.resize(4);  // the last is none of the file's
  scene.geometry.shapes.push_back(Sphere{1});
  for (uint32_t i = 0; i < kObjects / 2; ++i) {
    std::vector<TriangleMesh> parts(2);
    for (TriangleMesh& part : parts) {
      part.material = uniform.bits() % 4, part.first_primitive = uniform.bits() % 100;
      part.triangles.resize(kTriangles);
      for (uint32_t k = 0; k < kTriangles && i > 0; ++k) part.polygon_of_triangle.push_back(k / (1 + i));
    }
    scene.geometry.meshes.push_back({"", parts});
    scene.geometry.mesh_instances.push_back({i, 10 + i, {}});
    scene.geometry.shape_instances.push_back({0, 20 + i, uniform.bits() % 4, {}});
  }
  SurfaceIdReader read(scene);
  for (int trial = 0; trial < 20000; ++trial) {
    LaneArray<U> object, part, primitive;
    HitIds hit{kNone, 0, 0};
    for (size_t k = 0; k < kWidthOf<U>; ++k) {
      if (uniform.bits() % 4 == 0) hit.object = uniform.bits() % 3 ? uniform.bits() % kObjects : kNone;
      hit.part = uniform.bits() % 2, hit.primitive = uniform.bits() % (hit.object < kObjects / 2 ? kTriangles : 1);
      object[k] = hit.object, part[k] = hit.part, primitive[k] = hit.object == kNone ? uniform.bits() : hit.primitive;
    }
    const size_t count = 1 + uniform.bits() % kWidthOf<U>;
    const std::array<U, 3> ids = read(object.load(), part.load(), primitive.load(), count);
    std::array<uint32_t, 3 * (kWidthOf<U> + 1)> stored;
    stored.fill(7);
    LaneArray<IntOf<U>> places;  // from the last to the first
    for (size_t k = 0; k < kWidthOf<U>; ++k) places[k] = int32_t(3 * (kWidthOf<U> - 1 - k));
    store_triples_at(address_of<IntOf<U>>(stored.data(), places.load()), ids, count);
    for (size_t k = 0; k < kWidthOf<U>; ++k) {
      const uint32_t* found = &stored[size_t(places[k])];
      SurfaceIds expected{kNone, kNone, kNone};
      if (object[k] != kNone) expected = surface_ids(scene, {object[k], part[k], primitive[k]});
      if (k >= count) expected = {7, 7, 7};
      ASSERT_EQ((SurfaceIds{found[0], found[1], found[2]}), expected) << trial << " " << k;
    }
    ASSERT_EQ(stored.back(), 7u);
  }
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
