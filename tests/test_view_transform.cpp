// Display colours of scene-linear ones.
#include <gtest/gtest.h>

#include "apps/view_transform.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

constexpr ViewTransform kAll[] = {ViewTransform::standard, ViewTransform::pbr_neutral, ViewTransform::agx,
                                  ViewTransform::aces, ViewTransform::none};

TEST(ViewTransform, StaysInTheDisplaysRangeAndNeverTurnsBrighterIntoDarker) {
  for (const ViewTransform view : kAll) {
    float last = -1;
    for (float x = 0; x < 40; x = x * 1.1f + 1e-3f) {
      const Rgb c = display_linear(view, Rgb{x});
      ASSERT_GE(std::min({c.r, c.g, c.b}), 0);
      ASSERT_LE(max_component(c), 1);
      ASSERT_GE(c.g, last - 2e-3f) << int(view) << " at " << x;
      last = c.g;
    }
    for (const Rgb& wild : {Rgb{-1, -5, 0}, Rgb{1e30f, 0, 0}, Rgb{std::numeric_limits<float>::infinity()},
                            Rgb{std::numeric_limits<float>::quiet_NaN()}}) {
      const Rgb c = display_linear(view, wild);
      EXPECT_TRUE(is_finite(c));
    }
  }
}

TEST(ViewTransform, NeutralKeepsBaseColoursUnderFresnelsFourPercent) {
  // What a lit base colour becomes by a reflection of 4 % is taken off again.
  for (const Rgb& base : {Rgb{0.1f, 0.3f, 0.5f}, Rgb{0.7f, 0.2f, 0.1f}, Rgb{0.18f}}) {
    const Rgb c = display_linear(ViewTransform::pbr_neutral, base + Rgb{0.04f});
    EXPECT_NEAR(c.r, base.r, 1e-6f);
    EXPECT_NEAR(c.g, base.g, 1e-6f);
    EXPECT_NEAR(c.b, base.b, 1e-6f);
  }
}

TEST(ViewTransform, FilmLikeViewsTurnGreyIntoGreyAndBrightColoursIntoWhite) {
  for (const ViewTransform view : {ViewTransform::agx, ViewTransform::aces}) {
    const Rgb grey = display_linear(view, Rgb{0.18f});
    EXPECT_NEAR(grey.r, grey.b, 0.003f);
    EXPECT_GT(grey.g, 0.05f);
    EXPECT_LT(grey.g, 0.3f);
  }
  const Rgb bright = display_linear(ViewTransform::agx, {50, 0, 0});
  EXPECT_GT(bright.g, 0.2f);
}

TEST(ViewTransform, NoneWritesTheLinearNumber) {
  EXPECT_NEAR(srgb_from_linear(display_linear(ViewTransform::none, Rgb{0.25f}).g), 0.25f, 1e-5f);
}

TEST(ViewTransform, LeavesAlphaAndAppliesToStraightColours) {
  ColorImage image{2, 1, {"R", "G", "B", "A"}, {0.1f, 0.1f, 0.1f, 0.5f, 0, 0, 0, 0}};
  apply(ViewTransform::aces, image);
  EXPECT_EQ(image.pixels[3], 0.5f);
  EXPECT_FLOAT_EQ(image.pixels[0], 0.5f * display_linear(ViewTransform::aces, Rgb{0.2f}).r);
  EXPECT_EQ(image.pixels[4], 0);
}

}  // namespace
}  // namespace alhazen
