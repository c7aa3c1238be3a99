// Maps: what is wrong stands where it happened, in its colour.
#include <gtest/gtest.h>

#include <cmath>

#include "apps/crosscheck_map.h"
#include "crosscheck/plugin.h"
#include "materials/texture.h"

namespace alhazen::crosscheck {
namespace {

/// As `CrosscheckMap` lays out the sheets of one family.
constexpr int kSheetX = 16, kSheetY = 36, kSheetSide = 512;

std::array<uint8_t, 3> color_at(const ColorImage& image, int x, int y) {
  std::array<uint8_t, 3> color{};
  for (size_t k = 0; k < 3; ++k) color[k] = uint8_t(std::lround(255 * srgb_from_linear(image.at(x, y)[k])));
  return color;
}

std::array<uint8_t, 3> color_at(const ColorImage& image, const MapPlace& place) {
  const auto cell = [](double x) { return std::min(int(x * kSheetSide), kSheetSide - 1); };
  return color_at(image, kSheetX + cell(place.u), kSheetY + cell(place.v));
}

bool shows(const ColorImage& image, Mark mark, int height) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (color_at(image, x, y) == mark_color(mark)) return true;
  return false;
}

TEST(CrosscheckMap, AWrongIntersectorShowsWhereItIsWrongAndARightOneDoesNot) {
  const Plugin plugin(ALHAZEN_NAIVE_SPHERE);
  CrosscheckMap map(0, 0, 1);
  std::vector<MapPlace> wrong;
  Observer observer;
  observer.judged = [&](const Case& c) {
    map.add("naive", c);
    if (mark_of(c) == Mark::custom_wrong) wrong.push_back(map_places(c).front());
  };
  (void)check(family_of(plugin.intersector()), Population::silhouette,
              {.rays = 4096, .intersector = &plugin.intersector()}, observer);
  const ColorImage image = map.image();
  ASSERT_GT(wrong.size(), 100u);
  for (const MapPlace& place : wrong) {
    const auto color = color_at(image, place);
    EXPECT_TRUE(color == mark_color(Mark::custom_wrong) || color == mark_color(Mark::both_wrong));
  }

  CrosscheckMap right(0, 0, 1);
  observer.judged = [&](const Case& c) { right.add("sphere", c); };
  (void)check(built_in_families()[0], Population::silhouette, {.rays = 4096}, observer);
  EXPECT_TRUE(shows(right.image(), Mark::native_wrong, kSheetY + kSheetSide));
  EXPECT_FALSE(shows(right.image(), Mark::custom_wrong, kSheetY + kSheetSide));
}

TEST(CrosscheckMap, APictureMarksThePixelOfARay) {
  CrosscheckMap map(320, 200, 0);
  const auto add = [&](int x, int y, Verdict verdict) {
    Case c{};
    c.population = Population::camera, c.index = uint64_t(y) * 320 + uint64_t(x), c.verdict = verdict;
    map.add("scene", c);
  };
  add(100, 50, Verdict::b_right);
  add(0, 199, Verdict::tie_edge);
  const ColorImage image = map.image();
  EXPECT_EQ(color_at(image, 100, 50), mark_color(Mark::custom_wrong));
  EXPECT_EQ(color_at(image, 0, 199), mark_color(Mark::tie));
  EXPECT_EQ(color_at(image, 200, 100), (std::array<uint8_t, 3>{255, 255, 255}));
}

Case hit_of(const Subject& subject, const Rayf& ray) {
  Case c{};
  c.subject = &subject, c.ray = ray, c.truth = Judge(subject).closest(ray);
  return c;
}

TEST(CrosscheckMap, PlacesAreTheTextureCoordinatesOfTheHit) {
  const Subject sphere{Sphere{1}, {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {5, 0, 0}}};
  const auto places = map_places(hit_of(sphere, {{5, 0, 9}, {0, 0, -1}}));
  ASSERT_EQ(places.size(), 2u);
  EXPECT_NEAR(places[0].u, 0.5, 1e-6);
  EXPECT_NEAR(places[0].v, 0.5, 1e-6);
  EXPECT_EQ(places[1].sheet, SheetKind::outline);
  const Subject cylinder{Cylinder{2, 1, 1, true}, {}};
  EXPECT_EQ(map_places(hit_of(cylinder, {{0.5f, 9, 0}, {0, -1, 0}}))[0].sheet, SheetKind::flat_faces);
  EXPECT_EQ(map_places(hit_of(cylinder, {{9, 0, 0}, {-1, 0, 0}}))[0].sheet, SheetKind::surface);
  const Subject triangle{Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
  const auto weights = map_places(hit_of(triangle, {{0.25f, 0.5f, 1}, {0, 0, -1}}));
  EXPECT_NEAR(weights[0].u, 0.25, 1e-6);
  EXPECT_NEAR(weights[0].v, 0.5, 1e-6);
}

TEST(CrosscheckMap, AllSilhouettesOfASphereAreOneCircle) {
  Random random{3};
  const Subject sphere{Sphere{2}, {}};
  for (int k = 0; k < 100; ++k) {
    const Vec3d d = random.on_sphere(), off = normalize(cross(d, random.on_sphere())) * 2.0;
    Case c{};
    c.subject = &sphere, c.ray = {Vec3f(off - d * 5.0), Vec3f(d)};
    const auto places = map_places(c);
    ASSERT_EQ(places.size(), 1u);
    EXPECT_NEAR(std::hypot(places[0].u - 0.5, places[0].v - 0.5), 0.5 / kOutlineMargin, 1e-5);
  }
}

}  // namespace
}  // namespace alhazen::crosscheck
