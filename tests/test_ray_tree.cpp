// Claims about trees of rays: they are the picture's own, to the bit, and hang together.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <set>

#include "inspect/trace_pixel.h"
#include "tests/loaded_subject.h"
#include "tests/moving_scene.h"

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

/// A glass ball that falls before a wall, in whose light a sheet of colour passes.
MovingScene falling_ball() {
  MovingScene scene(3);
  const int matte = scene.phong({{"diffuseFactor", {0.8, 0.8, 0.8}}});
  const int glass = scene.phong({{"diffuseFactor", {0, 0, 0}}, {"transmissionFactor", {0.9, 0.8, 0.7}}});
  (void)scene.rectangle(9, 9, json::object(), matte);
  scene.move(scene.shape({{"sphere", {{"radius", 1}}}}, json::object(), glass), {-1, 2, 3, 1, -2, 3});
  scene.move(scene.shape({{"box", {{"size", {2, 9, 0.1}}}}}, json::object(), glass), {-3, 0, 5, 3, 0, 5});
  scene.move(scene.light(json::object()), {0, 3, 8, 3, 0, 8});
  return scene;
}

TEST(RayTree, SoDoTreesWhileTheShutterIsOpen) {
  MovingSubject subject(falling_ball());
  subject.open_shutter(0.1, 0.6);
  const RenderOptions options{.width = 48, .height = 40, .samples = 4};
  const ColorImage picture = subject.picture(options);
  std::set<float> times;
  size_t shadows = 0;
  subject.accelerated([&](const AcceleratedScene& accelerated) {
    for (int i = 0; i < 160; ++i) {
      const int x = i * 7 % 48, y = i / 4, sample = i % 4;
      const RayTree tree = trace_pixel(subject.scene(), accelerated, subject.scene().cameras[0], options, x, y, sample);
      ASSERT_TRUE(tree.time);
      times.insert(*tree.time);
      EXPECT_TRUE(same_bits(tree.pixel, picture.at(x, y))) << x << " " << y;
      EXPECT_EQ(sum_in_order(tree), tree.radiance);
      for (const TreeRay& ray : tree.rays)
        for (const TreeLight& light : ray.lights) {
          Rgb visible(1.0f);
          for (const Occluder& occluder : light.occluders) visible *= occluder.transmittance;
          shadows += !light.occluders.empty();
          EXPECT_NEAR(max_component(visible), max_component(light.visible), 1e-3f) << x << " " << y;
        }
    }
  });
  EXPECT_GT(times.size(), 100u);
  EXPECT_GT(shadows, 20u);
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
