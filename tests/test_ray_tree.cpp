// Claims about trees of rays: they are the picture's own, to the bit, and hang together.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "inspect/trace_pixel.h"
#include "tests/loaded_subject.h"

namespace alhazen {
namespace {

bool same_bits(const Rgb& a, const float* b) { return std::memcmp(&a, b, sizeof a) == 0; }

/// f(tree, the picture's pixel) for some pixels of every scene.
template <class F>
void for_trees(const RenderOptions& options, int pixels, const F& f) {
  for (const std::filesystem::path& file : small_scenes()) {
    SCOPED_TRACE(file.filename().string());
    const Subject subject(file, double(options.width) / options.height);
    const ColorImage picture = subject.picture(options);
    std::mt19937 engine(7);
    for (int i = 0; i < pixels; ++i) {
      const int x = int(engine() % unsigned(options.width)), y = int(engine() % unsigned(options.height));
      f(subject, x, y, picture.at(x, y));
    }
  }
}

TEST(RayTree, ContributionsSumToThePixelBitForBit) {
  const RenderOptions options{.width = 150, .height = 100};
  for_trees(options, 40, [&](const Subject& s, int x, int y, const float* pixel) {
    const RayTree tree = trace_pixel(s.scene, *s.accelerated, s.camera, options, x, y, 0);
    EXPECT_TRUE(same_bits(sum_in_order(tree), pixel)) << x << " " << y;
    EXPECT_TRUE(same_bits(tree.pixel, pixel)) << x << " " << y;
  });
}

TEST(RayTree, TreesOfAllSamplesAverageToThePixelBitForBit) {
  const RenderOptions options{.width = 96, .height = 64, .max_depth = 7, .samples = 3};
  for_trees(options, 6, [&](const Subject& s, int x, int y, const float* pixel) {
    Vec3d sum;
    for (int sample = 0; sample < options.samples; ++sample) {
      const RayTree tree = trace_pixel(s.scene, *s.accelerated, s.camera, options, x, y, sample);
      sum += Vec3d(tree.radiance.r, tree.radiance.g, tree.radiance.b);
      EXPECT_TRUE(same_bits(tree.pixel, pixel)) << x << " " << y;
    }
    const Vec3d mean = sum * (1.0 / options.samples);
    EXPECT_TRUE(same_bits({float(mean.x), float(mean.y), float(mean.z)}, pixel)) << x << " " << y;
  });
}

TEST(RayTree, WhatIsNotCoveredIsWhatAlphaLacks) {
  const RenderOptions options{.width = 96, .height = 64, .transparent = true};
  for_trees(options, 20, [&](const Subject& s, int x, int y, const float* pixel) {
    const RayTree tree = trace_pixel(s.scene, *s.accelerated, s.camera, options, x, y, 0);
    float uncovered = 0;
    for (const TreeRay& ray : tree.rays) uncovered += ray.uncovered;
    EXPECT_NEAR(1 - uncovered, pixel[3], 1e-5f);
    EXPECT_EQ(tree.alpha, pixel[3]);
  });
}

TEST(RayTree, EveryRayStartsWhereItsParentEnds) {
  const RenderOptions options{.width = 150, .height = 100};
  for_trees(options, 20, [&](const Subject& s, int x, int y, const float*) {
    const RayTree tree = trace_pixel(s.scene, *s.accelerated, s.camera, options, x, y, 0);
    ASSERT_FALSE(tree.rays.empty());
    EXPECT_EQ(tree.rays[0].parent, kNone);
    EXPECT_EQ(tree.rays[0].kind, RayKind::camera);
    for (size_t i = 1; i < tree.rays.size(); ++i) {
      const TreeRay& ray = tree.rays[i];
      ASSERT_LT(ray.parent, i);
      const TreeRay& parent = tree.rays[ray.parent];
      ASSERT_TRUE(parent.hit);
      const double scale = 1 + length(parent.hit->p_world);
      EXPECT_LT(length(Vec3d(ray.ray.origin) - parent.hit->p_world), 1e-4 * scale);
      EXPECT_LE(max_component(ray.weight), max_component(parent.weight) * 1.0001f);
      EXPECT_NEAR(length(ray.ray.direction), 1, 1e-5);
    }
  });
}

TEST(RayTree, HitsLieOnTheirRaysAndNormalsFaceTheirOrigins) {
  const RenderOptions options{.width = 150, .height = 100};
  for_trees(options, 20, [&](const Subject& s, int x, int y, const float*) {
    for (const TreeRay& ray : trace_pixel(s.scene, *s.accelerated, s.camera, options, x, y, 0).rays) {
      if (!ray.hit) continue;
      const Vec3d along = Vec3d(ray.ray.origin) + Vec3d(ray.ray.direction) * double(ray.hit->distance);
      EXPECT_LT(length(along - ray.hit->p_world), 1e-4 * (1 + length(along)));
      EXPECT_LE(dot(ray.hit->ns_world, ray.ray.direction), 0);
    }
  });
}

TEST(RayTree, OccludersMultiplyToTheVisibility) {
  const RenderOptions options{.width = 150, .height = 100};
  size_t shadows = 0;
  for_trees(options, 30, [&](const Subject& s, int x, int y, const float*) {
    for (const TreeRay& ray : trace_pixel(s.scene, *s.accelerated, s.camera, options, x, y, 0).rays)
      for (const TreeLight& light : ray.lights) {
        Rgb visible(1.0f);
        for (const Occluder& occluder : light.occluders) visible *= occluder.transmittance;
        shadows += !light.occluders.empty();
        EXPECT_NEAR(max_component(visible), max_component(light.visible), 1e-3f) << x << " " << y;
      }
  });
  EXPECT_GT(shadows, 20u);
}

TEST(RayTree, LightsArePartedIntoWhatTheyAdd) {
  const RenderOptions options{.width = 150, .height = 100};
  for_trees(options, 20, [&](const Subject& s, int x, int y, const float*) {
    for (const TreeRay& ray : trace_pixel(s.scene, *s.accelerated, s.camera, options, x, y, 0).rays)
      for (const TreeLight& light : ray.lights) {
        const Rgb weight = ray.hit->arriving * ray.hit->alpha;
        const Rgb sum = weight * light.arriving * (light.diffuse + light.specular) * light.visible;
        EXPECT_NEAR(sum.g, light.addend.light.g, 1e-4f * (1 + sum.g));
      }
  });
}

}  // namespace
}  // namespace alhazen
