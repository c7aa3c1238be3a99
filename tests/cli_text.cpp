// Claims about what the program says: suggestions, progress, brightness notes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "apps/exposure.h"
#include "apps/progress.h"
#include "apps/suggestion.h"

namespace alhazen {
namespace {

TEST(Suggestion, EditDistanceCountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("render", "rendr"), 1u);
  EXPECT_EQ(edit_distance("render", "redner"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Suggestion, EditDistanceIsSymmetricAndAtMostTheEditsMade) {
  std::mt19937 rng(3);
  const auto below = [&](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(rng); };
  const auto letter = [&] { return char('a' + int(below(4))); };
  for (int i = 0; i < 2000; ++i) {
    std::string a(1 + below(10), ' ');
    for (char& c : a) c = letter();
    std::string b = a;
    const size_t edits = below(4);
    for (size_t k = 0; k < edits; ++k) {
      const size_t kind = below(3);
      if (kind == 0 && !b.empty()) b.erase(below(b.size()), 1);
      if (kind == 1) b.insert(below(b.size() + 1), 1, letter());
      if (kind == 2 && !b.empty()) b[below(b.size())] = letter();
    }
    ASSERT_LE(edit_distance(a, b), edits) << a << " " << b;
    ASSERT_EQ(edit_distance(a, b), edit_distance(b, a)) << a << " " << b;
  }
}

TEST(Suggestion, OnlyNearWordsAreSuggested) {
  const std::vector<std::string> known{"render", "info", "convert"};
  EXPECT_EQ(did_you_mean("rendr", known), "; did you mean 'render'?");
  EXPECT_EQ(did_you_mean("inof", known), "; did you mean 'info'?");
  EXPECT_EQ(did_you_mean("paint", known), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
}

TEST(Progress, TheLineSaysHowFarAndHowLong) {
  const Progress progress{612, 920, 0.665, 65190000, 4.1};
  EXPECT_EQ(progress_text("scene 1280x720 16 spp", progress),
            "scene 1280x720 16 spp  [612/920 tiles  66%]  15.9 Mray/s  4.1 s elapsed  2.1 s left");
  EXPECT_EQ(progress_text("scene", {0, 920, 0, 0, 0}), "scene  [0/920 tiles   0%]  0.0 Mray/s  0.0 s elapsed");
}

TEST(Progress, DurationsReadAsPeopleSayThem) {
  EXPECT_EQ(duration_text(4.13), "4.1 s");
  EXPECT_EQ(duration_text(59.99), "1:00");
  EXPECT_EQ(duration_text(125), "2:05");
  EXPECT_EQ(duration_text(3725), "1:02:05");
}

TEST(Progress, ReportsSlowDown) {
  for (const ProgressStyle style : {ProgressStyle::renewed, ProgressStyle::plain, ProgressStyle::json})
    for (double t = 0; t < 1e5; t += 97) EXPECT_LE(report_interval(style, t), report_interval(style, t + 97));
  EXPECT_LT(report_interval(ProgressStyle::renewed, 0), report_interval(ProgressStyle::renewed, 60));
}

TEST(Exposure, TheSuggestedStopsKeepNearlyAllOfThePicture) {
  std::mt19937 rng(9);
  for (const float brightest : {0.9f, 1.5f, 4.0f, 300.0f}) {
    std::uniform_real_distribution<float> u(0, brightest);
    ColorImage image{100, 100, {"R", "G", "B", "A"}, {}};
    for (int i = 0; i < 100 * 100; ++i) image.pixels.insert(image.pixels.end(), {u(rng), u(rng), u(rng), 1.0f});
    const Clipping before = clipping(image);
    EXPECT_EQ(before.share > 0, brightest > 1) << brightest;
    EXPECT_LE(before.stops, 0);
    expose(image, before.stops);
    EXPECT_LE(clipping(image).share, 0.0101) << brightest;
  }
}

}  // namespace
}  // namespace alhazen
