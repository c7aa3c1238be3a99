// Motion blur: pictures against analytic coverage, and against the mean of stills over the shutter's time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "accel/posed.h"
#include "tests/moving_scene.h"

namespace alhazen {
namespace {

RenderOptions size(int width, int height, int samples) {
  RenderOptions options;
  options.width = width, options.height = height, options.samples = samples;
  return options;
}

// ---- Analytic coverage ----

void expect_trapezoid(const MovingScene& scene, double width) {
  MovingSubject stage(scene);
  const ColorImage picture = stage.blurred(0, 1, size(40, 4, 256));
  for (const auto& track : stage.scene().geometry.motion.places) EXPECT_TRUE(track.empty() || track.size() == 2);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 40; ++x) EXPECT_NEAR(double(*picture.at(x, y)), trapezoid(x + 0.5 - 20, width), 0.02) << x;
}

TEST(Shutter, ARectangleAtConstantSpeedCoversATrapezoid) {
  for (const float width : {3.0f, 6.0f, 15.0f}) {
    MovingScene scene(2);
    scene.move(scene.rectangle(width, 20), {-10, 0, 0, 10, 0, 0});
    expect_trapezoid(scene, double(width));
  }
}

TEST(Shutter, SoDoesAnAnalyticBox) {
  MovingScene scene(2);
  scene.move(scene.shape({{"box", {{"size", {6, 20, 1}}}}}), {-10, 0, 0, 10, 0, 0});
  expect_trapezoid(scene, 6);
}

TEST(Shutter, SoDoesARectangleThatMorphsThere) {
  MovingScene scene(2);
  const int left = scene.vec3({-10, 0, 0, -10, 0, 0, -10, 0, 0, -10, 0, 0}),
            right = scene.vec3({10, 0, 0, 10, 0, 0, 10, 0, 0, 10, 0, 0});
  const int node = scene.rectangle(6, 20, {{"targets", {{{"POSITION", left}}, {{"POSITION", right}}}}});
  scene.animate(node, "weights", {1, 0, 0, 1}, 2);
  expect_trapezoid(scene, 6);
}

TEST(Shutter, SoDoesAStandingRectangleBeforeAMovingCamera) {
  MovingScene scene(2);
  (void)scene.rectangle(6, 20);
  scene.move(scene.camera, {10, 0, 10, -10, 0, 10});
  MovingSubject stage(scene);
  const ColorImage picture = stage.blurred(0, 1, size(40, 4, 256));
  for (int x = 0; x < 40; ++x) EXPECT_NEAR(double(*picture.at(x, 2)), trapezoid(x + 0.5 - 20, 6), 0.02) << x;
}

// ---- Against stills ----

/// The mean of stills in the middles of even parts of the shutter's time.
std::vector<double> mean_of_stills(MovingSubject& stage, double open, double shutter, int stills,
                                   const RenderOptions& options) {
  std::vector<double> mean(size_t(options.width) * size_t(options.height) * 4);
  for (int k = 0; k < stills; ++k) {
    stage.file.move(stage.scene(), open + shutter * (k + 0.5) / stills);
    const ColorImage still = stage.picture(options);
    for (size_t i = 0; i < mean.size(); ++i) mean[i] += double(still.pixels[i]) / stills;
  }
  return mean;
}

void expect_mean_of_stills(const MovingScene& scene) {
  MovingSubject stage(scene);
  const ColorImage picture = stage.blurred(0.1, 0.7, size(32, 24, 512));
  const std::vector<double> expected = mean_of_stills(stage, 0.1, 0.7, 96, size(32, 24, 16));
  double sum = 0, largest = 0, blurred = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    const double difference = std::abs(double(picture.pixels[i]) - expected[i]);
    sum += difference, largest = std::max(largest, difference);
    blurred += expected[i] > 0.1 && expected[i] < 0.9;
  }
  EXPECT_LT(largest, 0.07);
  EXPECT_LT(sum / double(expected.size()), 0.003);
  EXPECT_GT(blurred, 0.02 * double(expected.size()));  // there is something to see
}

TEST(Shutter, ATurningBarIsTheMeanOfItsStills) {
  MovingScene scene(3);
  scene.turn(scene.rectangle(5, 1), {0, 150, 300});
  expect_mean_of_stills(scene);
}

TEST(Shutter, ATurningAnalyticBarToo) {
  MovingScene scene(3);
  scene.turn(scene.shape({{"box", {{"size", {5, 1, 0.5}}}}}), {0, 150, 300});
  expect_mean_of_stills(scene);
}

TEST(Shutter, AMorphingTriangleUnderATurningNodeToo) {
  MovingScene scene(3);
  const int delta = scene.vec3({0, 0, 0, 1.5f, 1.5f, 0, -2, 1, 0, 0, 0, 0});
  const int node = scene.rectangle(3, 2, {{"targets", {{{"POSITION", delta}}}}});
  scene.animate(node, "weights", {0, 1, 0.2f}, 1);
  scene.turn(node, {0, 60});
  expect_mean_of_stills(scene);
}

TEST(Shutter, ASphereSeenInAMirrorToo) {
  MovingScene scene(3);
  const int mirror = scene.phong({{"diffuseFactor", {0, 0, 0}}, {"reflectionFactor", {0.8, 0.8, 0.8}}});
  scene.shape({{"box", {{"size", {4, 4, 0.2}}}}},
              {{"rotation", {0, std::sin(std::numbers::pi / 12), 0, std::cos(std::numbers::pi / 12)}}}, mirror);
  const int sphere = scene.shape({{"sphere", {{"radius", 0.8}}}});
  scene.move(sphere, {4, -2, 3, 4, 2, 3});
  scene.move(scene.shape({{"sphere", {{"radius", 0.3}}}}), {-2, 2, 1, 2, 1, 1, -2, -2, 1});
  expect_mean_of_stills(scene);
}

TEST(Shutter, AShadowOfAMovingSphereUnderAMovingLightToo) {
  MovingScene scene(3);
  const int matte = scene.phong({{"diffuseFactor", {0.8, 0.8, 0.8}}});
  (void)scene.rectangle(9, 9, json::object(), matte);
  scene.move(scene.shape({{"sphere", {{"radius", 0.5}}}}, json::object(), matte), {-2, 0, 1.5, 2, 1, 1.5});
  scene.move(scene.light({{"translation", {0, 0, 5}}}), {2, 0, 5, -1, 2, 4});
  expect_mean_of_stills(scene);
}

TEST(Shutter, WhatIsSeenByAMovingCameraToo) {
  MovingScene scene(3);
  (void)scene.rectangle(4, 1);
  scene.turn(scene.camera, {0, 90});
  expect_mean_of_stills(scene);
}

// ---- Recorded motion ----

TEST(Shutter, WhatIsRecordedKeepsToItsPlaceBetweenThePoses) {
  MovingScene scene(3);
  scene.turn(scene.rectangle(5, 1), {0, 170, 340});
  const int shape = scene.shape({{"sphere", {{"radius", 1}}}});
  scene.move(shape, {0, 0, 0, 5, 0, 0, 5, 5, 0, 0, 5, 0, 0, 0, 0});
  MovingSubject stage(scene);
  record_motion(stage.file, stage.scene(), 0, 1);
  const Geometry recorded = [&] {
    Geometry g;
    g.mesh_instances = stage.scene().geometry.mesh_instances,
    g.shape_instances = stage.scene().geometry.shape_instances;
    g.motion = stage.scene().geometry.motion;
    return g;
  }();
  for (int i = 0; i <= 1000; ++i) {
    stage.file.move(stage.scene(), i / 1000.0);
    for (const uint32_t object : {0u, 1u}) {
      const Affine3d then = world_from_object(recorded, object, float(i) / 1000),
                     expected = world_from_object(stage.scene().geometry, object, 0);
      for (const Vec3d& corner : {Vec3d{2.5, 0.5, 0}, Vec3d{-2.5, 0.5, 0}})
        EXPECT_LT(length(transform_point(then, corner) - transform_point(expected, corner)), 5.1 / 1000) << i;
    }
  }
}

TEST(Shutter, WhatStandsStillHasNoTrack) {
  MovingScene scene(3);
  const int moves = scene.rectangle(1, 1);
  (void)scene.rectangle(2, 2), (void)scene.shape({{"sphere", {{"radius", 1}}}});
  scene.move(moves, {0, 0, 0, 1, 0, 0});
  MovingSubject stage(scene);
  record_motion(stage.file, stage.scene(), 0, 1);
  const Motion& motion = stage.scene().geometry.motion;
  ASSERT_EQ(motion.places.size(), 3u);
  EXPECT_EQ(motion.places[0].size(), 2u);
  EXPECT_TRUE(motion.places[1].empty() && motion.places[2].empty() && motion.meshes.empty());
  EXPECT_TRUE(stage.scene().cameras[0].track.empty());
  stage.file.move(stage.scene(), 1);
  record_motion(stage.file, stage.scene(), 1, 5);  // after the last key
  EXPECT_TRUE(stage.scene().geometry.motion.empty());
}

TEST(Shutter, WhatVanishesWhileItIsOpenIsAsAtTheOpening) {
  MovingScene scene(3);
  const int node = scene.rectangle(1, 1);
  scene.animate(node, "scale", {1, 1, 1, 0, 0, 0}, 3);
  const TemporaryFolder folder;
  GltfFile file(folder.write("scene.gltf", scene.text()), [](const std::string&) {}, {},
                {.animation = {}, .time = 0.0});
  LoadedScene loaded = file.load(0);
  record_motion(file, loaded.scene, 0, 1);
  ASSERT_EQ(loaded.scene.geometry.mesh_instances.size(), 1u);
  EXPECT_TRUE(loaded.scene.geometry.motion.empty());
}

// ---- From frame to frame ----

/// Meshes and shapes that stand, move, deform and do both; mirrors; a mesh in two places.
MovingScene varied_scene() {
  MovingScene scene(3);
  const int mirror = scene.phong({{"diffuseFactor", {0.5, 0.5, 0.5}}, {"reflectionFactor", {0.5, 0.5, 0.5}}});
  const int standing = scene.rectangle(9, 9, json::object(), mirror);
  scene.root["nodes"][size_t(standing)]["translation"] = {0, 0, -1};
  scene.turn(scene.rectangle(5, 1, json::object(), mirror), {0, 150, 300});
  const int delta = scene.vec3({0, 0, 0, 1.5f, 1.5f, 0, -2, 1, 0, 0, 0, 0});
  const int morphing = scene.rectangle(2, 1, {{"targets", {{{"POSITION", delta}}}}}, mirror);
  scene.animate(morphing, "weights", {0, 1, 0.2f}, 1);
  scene.move(morphing, {-2, -2, 0.5f, 2, -2, 0.5f});
  scene.add("nodes", {{"mesh", 0}, {"translation", {1, 1, 0.2}}, {"scale", {0.1, 0.1, 0.1}}});
  scene.move(scene.shape({{"sphere", {{"radius", 0.7}}}}, json::object(), mirror), {-2, 0, 1, 2, 1, 1});
  scene.shape({{"sphere", {{"radius", 0.5}}}}, {{"translation", {0, -1, 1}}}, mirror);
  (void)scene.light({{"translation", {0, 3, 5}}});
  return scene;
}

void expect_frames_as_built_anew(bool watertight, double shutter) {
  MovingSubject stage(varied_scene());
  const MovingParts moving{stage.file.moving_meshes(), stage.file.deforming_meshes(), stage.file.moving_nodes()};
  const BuildOptions options{.watertight = watertight, .moving = moving};
  std::vector<Opacity> opacity, opacity_again;
  std::unique_ptr<AcceleratedScene> kept;
  const auto pixels = [&](const AcceleratedScene& accelerated) {
    RenderControl control;
    return render(stage.scene(), accelerated, stage.scene().cameras[0], size(60, 45, 2), control).color.pixels;
  };
  for (const double time : {0.0, 0.3, 0.31, 0.9, 1.0, 0.1}) {
    stage.file.move(stage.scene(), time);
    if (shutter > 0) record_motion(stage.file, stage.scene(), time, shutter);
    const SurfaceFilter filter = surface_filter(stage.scene(), opacity);
    if (kept)
      ASSERT_TRUE(kept->update(filter));
    else
      kept = std::make_unique<AcceleratedScene>(stage.scene().geometry, filter, options);
    const SurfaceFilter filter_again = surface_filter(stage.scene(), opacity_again);
    const AcceleratedScene anew(stage.scene().geometry, filter_again, options);
    EXPECT_EQ(pixels(*kept), pixels(anew)) << time;
  }
}

TEST(Frames, KeepWhatStandsStillAndLookAsIfBuiltAnew) {
  expect_frames_as_built_anew(false, 0);
  expect_frames_as_built_anew(true, 0);
}

TEST(Frames, DoSoWithMotionBlurToo) { expect_frames_as_built_anew(false, 0.2); }

TEST(Frames, AreBuiltAnewWhereObjectsOrOpacitiesAreOthers) {
  MovingSubject stage(varied_scene());
  const MovingParts moving{stage.file.moving_meshes(), stage.file.deforming_meshes(), stage.file.moving_nodes()};
  std::vector<Opacity> opacity;
  Scene& scene = stage.scene();
  AcceleratedScene accelerated(scene.geometry, surface_filter(scene, opacity), {.moving = moving});
  EXPECT_TRUE(accelerated.update(surface_filter(scene, opacity)));
  scene.materials[1].alpha_mode = AlphaMode::blend;
  EXPECT_FALSE(accelerated.update(surface_filter(scene, opacity)));
  scene.materials[1].alpha_mode = AlphaMode::opaque;
  EXPECT_TRUE(accelerated.update(surface_filter(scene, opacity)));
  scene.geometry.shape_instances.pop_back();
  EXPECT_FALSE(accelerated.update(surface_filter(scene, opacity)));
}

TEST(Shutter, SameBitsForAnyThreadsAndTiles) {
  MovingScene scene(3);
  const int mirror = scene.phong({{"diffuseFactor", {0.5, 0.5, 0.5}}, {"reflectionFactor", {0.5, 0.5, 0.5}}});
  scene.turn(scene.rectangle(5, 1, json::object(), mirror), {0, 150, 300});
  scene.move(scene.shape({{"sphere", {{"radius", 1}}}}, json::object(), mirror), {-2, 0, 1, 2, 1, 1});
  (void)scene.light({{"translation", {0, 3, 5}}});
  MovingSubject stage(scene);
  for (const int samples : {1, 5}) {
    RenderOptions options = size(100, 70, samples);
    options.threads = 1, options.tile_size = 32;
    const ColorImage reference = stage.blurred(0, 1, options);
    for (const int threads : {1, 2, 3})
      for (const int tile : {8, 64, 1000}) {
        options.threads = threads, options.tile_size = tile;
        const ColorImage again = stage.blurred(0, 1, options);
        EXPECT_EQ(std::memcmp(again.pixels.data(), reference.pixels.data(), again.pixels.size() * sizeof(float)), 0)
            << threads << " threads, tiles of " << tile;
      }
  }
}

}  // namespace
}  // namespace alhazen
