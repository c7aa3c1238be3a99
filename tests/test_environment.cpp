// Light from all around, and bodies that refract and dim it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "decide.h"
#include "renderer/environment.h"
#include "renderer/media.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

ColorImage sky_image(int width, const std::function<Rgb(int x, int y)>& color) {
  ColorImage image{width, width / 2, {"R", "G", "B"}, {}};
  for (int y = 0; y < width / 2; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb c = color(x, y);
      image.pixels.insert(image.pixels.end(), {c.r, c.g, c.b});
    }
  return image;
}

Vec3f random_direction(Rng& rng) { return normalize(Vec3f(uniform_vector(rng, -1, 1))); }

TEST(Environment, OfOneColourIsThatColourForEveryLobe) {
  const Rgb color{0.2f, 0.5f, 3.0f};
  Environment environment = make_environment(sky_image(64, [&](int, int) { return color; }));
  environment.strength = 2;
  Rng rng(3);
  for (int k = 0; k < 100; ++k) {
    const Vec3f d = random_direction(rng);
    for (const Rgb& c :
         {environment_radiance(environment, d, float(uniform(rng, 0, 1))), environment_diffuse(environment, d)}) {
      EXPECT_NEAR(c.r, 0.4f, 0.01f);
      EXPECT_NEAR(c.b, 6.0f, 0.06f);
    }
  }
}

TEST(Environment, MiddleOfTheImageIsMinusZAndItsRightHalfPlusX) {
  const Environment environment = make_environment(sky_image(64, [](int x, int y) {
    return Rgb{x > 28 && x < 35 ? 1.0f : 0.0f, x > 44 && x < 51 ? 1.0f : 0.0f, y < 4 ? 1.0f : 0.0f};
  }));
  EXPECT_EQ(environment_radiance(environment, {0, 0, -1}, 0), (Rgb{1, 0, 0}));
  EXPECT_EQ(environment_radiance(environment, {1, 0, 0}, 0), (Rgb{0, 1, 0}));
  EXPECT_EQ(environment_radiance(environment, {0, 1, 0}, 0).b, 1);
}

TEST(Environment, ASmallSunLightsLikeADirectionalLight) {
  // Degree 2 is what a Lambertian surface sees of anything, to some percent where it faces the light.
  const int width = 128;
  const double pixel = 2 * std::numbers::pi / width;
  const Environment environment = make_environment(sky_image(width, [&](int x, int y) {
    return Rgb{y < 2 ? float(1 / (2 * std::numbers::pi * (1 - std::cos(2 * pixel)))) : 0.0f} * float(x >= 0);
  }));
  // Irradiance 1 from +y.
  EXPECT_NEAR(environment_diffuse(environment, {0, 1, 0}).g * std::numbers::pi, 1.0625, 0.03);
  EXPECT_NEAR(environment_diffuse(environment, {0, -1, 0}).g * std::numbers::pi, 0.0625, 0.03);
}

TEST(Environment, RougherLobesSeeItSmoother) {
  Rng rng(1);
  const Environment environment =
      make_environment(sky_image(64, [&](int, int) { return Rgb{float(uniform(rng, 0, 1))}; }));
  float last = std::numeric_limits<float>::infinity();
  for (const float roughness : {0.0f, 0.2f, 0.4f, 0.6f, 1.0f}) {
    float low = 1, high = 0;
    for (int k = 0; k < 500; ++k) {
      const float value = environment_radiance(environment, random_direction(rng), roughness).g;
      low = std::min(low, value), high = std::max(high, value);
    }
    EXPECT_LT(high - low, last);
    last = high - low;
  }
}

/// The middle pixel of a picture along -z from (0, 0, 5).
Rgb seen_along_z(const Scene& scene, int max_depth = 8) {
  std::vector<Opacity> opacity;
  const SurfaceFilter filter = surface_filter(scene, opacity);
  const AcceleratedScene accelerated(scene.geometry, filter);
  RenderControl control;
  RenderOptions options;
  options.width = options.height = 3, options.max_depth = max_depth, options.min_weight = 0;
  Camera camera;
  camera.world_from_camera.origin = {0, 0, 5}, camera.yfov = 0.01;
  const RenderResult result = render(scene, accelerated, camera, options, control);
  const float* p = result.color.at(1, 1);
  return {p[0], p[1], p[2]};
}

Material glass(float ior) {
  Material m;
  m.metallic = 0, m.roughness = 0, m.transmission = 1, m.ior = ior;
  m.volume.thickness = 1;
  return m;
}

void place(Scene& scene, const Shape& shape, uint32_t material, const Vec3d& at = {}) {
  Affine3d m;
  m.origin = at;
  scene.geometry.shapes.push_back(shape);
  scene.geometry.shape_instances.push_back({uint32_t(scene.geometry.shapes.size() - 1), 0, material, m});
}

TEST(Volume, DimsLightByBeersLawOnTheWayInside) {
  Scene scene;
  scene.materials = {glass(1), Material{}};  // ior 1: nothing is reflected
  scene.materials[0].volume.attenuation_color = {0.5f, 0.25f, 1.0f};
  scene.materials[0].volume.attenuation_distance = 2;
  scene.background = Rgb{1.0f};
  place(scene, Box{{4, 4, 3}}, 0);
  const Rgb c = seen_along_z(scene);
  EXPECT_NEAR(c.r, std::pow(0.5f, 1.5f), 1e-4f);
  EXPECT_NEAR(c.g, std::pow(0.25f, 1.5f), 1e-4f);
  EXPECT_NEAR(c.b, 1, 1e-4f);
}

TEST(Volume, GlassInGlassOfTheSameIndexIsNotSeen) {
  // One slab of ior 1.5 reflects at its two faces only, whatever else of ior 1.5 is inside of it.
  const auto with_slabs = [](int count) {
    Scene scene;
    scene.materials = {glass(1.5f), glass(1.5f), Material{}};
    scene.background = Rgb{1.0f};
    scene.has_background = true;
    place(scene, Box{{4, 4, 3}}, 0);
    if (count > 1) place(scene, Box{{4, 4, 1}}, 1);
    return seen_along_z(scene, 1);  // the refracted ray ends at the second face
  };
  EXPECT_EQ(with_slabs(1).g, with_slabs(2).g);
}

TEST(Media, TheBodyEnteredLastRulesAmongEquals) {
  const std::vector<Material> materials{glass(1.5f), glass(1.33f)};
  const Boundary into_glass = cross_boundary({}, 0, true, materials);
  EXPECT_EQ(into_glass.ior_before.g, 1);
  EXPECT_EQ(into_glass.ior_after.g, 1.5f);
  const Boundary into_water = cross_boundary(into_glass.after, 1, true, materials);
  EXPECT_EQ(into_water.ior_before.g, 1.5f);
  EXPECT_EQ(into_water.ior_after.g, 1.33f);
  // Out of the glass while still in the water that overlaps it: nothing to see.
  const Boundary out_of_glass = cross_boundary(into_water.after, 0, false, materials);
  EXPECT_FALSE(out_of_glass.seen);
  const Boundary into_air = cross_boundary(out_of_glass.after, 1, false, materials);
  EXPECT_EQ(into_air.ior_after.g, 1);
  EXPECT_EQ(into_air.after.count, 0);
}

TEST(Media, TheHigherPriorityRulesWhereBodiesOverlap) {
  std::vector<Material> materials(2);
  for (Material& m : materials) m.model = ShadingModel::phong, m.phong.takes_part = true;
  materials[0].phong.ior = 1.5f, materials[0].phong.priority = 2;
  materials[1].phong.ior = 1.33f, materials[1].phong.priority = 1;
  const Boundary into_glass = cross_boundary({}, 0, true, materials);
  const Boundary into_water = cross_boundary(into_glass.after, 1, true, materials);
  EXPECT_FALSE(into_water.seen);
  const Boundary out_of_glass = cross_boundary(into_water.after, 0, false, materials);
  EXPECT_TRUE(out_of_glass.seen);
  EXPECT_EQ(out_of_glass.ior_before.g, 1.5f);
  EXPECT_EQ(out_of_glass.ior_after.g, 1.33f);
}

TEST(Media, ARayThatStartsInsideLeavesWhatItNeverEntered) {
  const std::vector<Material> materials{glass(1.5f)};
  const Boundary out = cross_boundary({}, 0, false, materials);
  EXPECT_EQ(out.ior_before.g, 1.5f);
  EXPECT_EQ(out.ior_after.g, 1);
  EXPECT_EQ(out.after.count, 0);
}

TEST(Media, ForgetsTheOutermostOfManyBodies) {
  const std::vector<Material> materials(10, glass(1.5f));
  Media media;
  for (uint32_t k = 0; k < 10; ++k) media = cross_boundary(media, k, true, materials).after;
  EXPECT_EQ(media.count, Media::kMost);
  for (uint32_t k = 10; k-- > 0;) media = cross_boundary(media, k, false, materials).after;
  EXPECT_EQ(media.count, 0);
}

TEST(Dispersion, BendsBlueMoreThanRedAndSpreadsByTheAbbeNumber) {
  Material m = glass(1.5f);
  m.volume.dispersion = 0.5f;  // Abbe number 40
  const Boundary into = cross_boundary({}, 0, true, {m});
  EXPECT_LT(into.ior_after.r, into.ior_after.g);
  EXPECT_NEAR((into.ior_after.g - 1) / (into.ior_after.b - into.ior_after.r), 40, 0.01);
}

}  // namespace
}  // namespace alhazen
