// Claims about code that is written once for floats and for lanes of them: every lane has the float's bits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/angle.h"
#include "core/power.h"
#include "materials/base_layer.h"
#include "materials/phong.h"
#include "materials/texture.h"
#include "renderer/environment.h"
#include "renderer/light.h"
#include "tests/uniform.h"

namespace alhazen {
namespace {

using F = ShadingLanes;
constexpr size_t kLanes = kWidthOf<F>;

bool same_bits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(ShadingLanes, AnglesAreThoseOfTheLibraryToFewRoundings) {
  Uniform uniform(1);
  for (int i = 0; i < 200000; ++i) {
    const float x = uniform(-1, 1), y = uniform(-1, 1) * std::exp2(uniform(-20, 20));
    EXPECT_NEAR(arc_cosine(x), std::acos(double(x)), 3.5e-7);
    EXPECT_NEAR(arc_tangent(y, x), std::atan2(double(y), double(x)), 3.5e-7) << y << " " << x;
  }
  EXPECT_EQ(arc_cosine(1.0f), 0);
  EXPECT_EQ(arc_tangent(0.0f, 0.0f), 0);
  EXPECT_FLOAT_EQ(arc_tangent(0.0f, -1.0f), std::numbers::pi_v<float>);
}

TEST(ShadingLanes, PowersAreThoseOfTheLibraryToFewRoundings) {
  Uniform uniform(6);
  for (int i = 0; i < 200000; ++i) {
    LaneArray<F> x, powers;
    const float exponent = i % 9 ? std::exp2(uniform(-4, 14)) : 0;
    for (size_t k = 0; k < kLanes; ++k)
      x[k] = k == 0 ? 1 : k % 2 ? 1 - std::exp2(uniform(-24, 0)) : std::exp2(uniform(-126, 0));
    powers.store(power(x.load(), F(exponent)));
    for (size_t k = 0; k < kLanes; ++k) {
      const double expected = std::pow(double(x[k]), double(exponent));
      const double allowed = 2e-7 * (1 + std::abs(std::log2(expected))) * expected;
      if (expected < 0x1p-125)
        EXPECT_LE(powers[k], 0x1p-124f);
      else
        EXPECT_NEAR(powers[k], expected, allowed) << x[k] << " " << exponent;
      EXPECT_TRUE(same_bits(powers[k], power(x[k], exponent)));
    }
  }
}

TEST(ShadingLanes, NextUpIsTheNeighbourInEveryLane) {
  Uniform uniform(2);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 20000; ++i) {
    LaneArray<F> x, up;
    for (size_t k = 0; k < kLanes; ++k) {
      const uint32_t bits = uniform.bits();
      x[k] = k == 0 ? 0 : std::bit_cast<float>(bits);
      if (!std::isfinite(x[k])) x[k] = -kInfinity;
    }
    up.store(next_up(x.load()));
    for (size_t k = 0; k < kLanes; ++k) EXPECT_EQ(up[k], std::nextafter(x[k], kInfinity)) << x[k];
  }
}

/// Images of each kind of sample and number of channels, with and without mip levels.
TextureImage random_image(Uniform& uniform, int index) {
  TextureImage image{.width = 1 + int(uniform.bits() % 37),
                     .height = 1 + int(uniform.bits() % 23),
                     .channels = 1 + index % 4,
                     .samples = {}};
  MipLevel last{image.width, image.height};
  while (index % 5 && (last.width > 1 || last.height > 1)) last = last.next(), ++image.levels;
  const auto fill = [&](auto value) {
    const size_t texels = last.first_texel + size_t(last.width) * size_t(last.height);
    std::vector<decltype(value())> samples(texels * size_t(image.channels));
    for (auto& sample : samples) sample = value();
    image.samples = samples;
  };
  if (index % 3 == 0) fill([&] { return uint8_t(uniform.bits()); });
  if (index % 3 == 1) fill([&] { return uint16_t(uniform.bits()); });
  if (index % 3 == 2) fill([&] { return uniform(0, 2); });
  return image;
}

TEST(ShadingLanes, TexturesAreLookedUpToTheBit) {
  Uniform uniform(3);
  for (int i = 0; i < 3000; ++i) {
    const std::vector<TextureImage> images{random_image(uniform, i)};
    const auto wrap = [&] { return Wrap(uniform.bits() % 3); };
    const std::vector<Texture> textures{{.image = 0,
                                         .wrap_u = wrap(),
                                         .wrap_v = wrap(),
                                         .nearest = uniform.bits() % 2 == 0,
                                         .nearest_small = uniform.bits() % 2 == 0,
                                         .mipmaps = Mipmaps(uniform.bits() % 3)}};
    const TextureUse use{0, 0, uniform(-3, 3), uniform(-1, 1), uniform(-2, 2), uniform(-1, 1), uniform(-3, 3), 0.5f};
    const ColorSpace space = uniform.bits() % 2 ? ColorSpace::srgb : ColorSpace::linear;
    LaneArray<F> u, v, footprint, density;
    for (size_t k = 0; k < kLanes; ++k) {
      u[k] = uniform(-3, 3), v[k] = k == 3 ? NAN : uniform(-1e4f, 1e4f);
      footprint[k] = k % 4 ? std::exp2(uniform(-12, 8)) : 0, density[k] = uniform(0, 2);
    }
    const Vec2<F> uv{u.load(), v.load()};
    const F per_metre = density.load();
    const BasicRgba<F> lanes = sample(TextureTable{&textures, &images}, use, space,
                                      BasicSurfaceInputs<F>{&uv, 1, {}, footprint.load(), &per_metre});
    RgbArray<F> rgb;
    LaneArray<F> a;
    rgb.store(lanes.rgb), a.store(lanes.a);
    for (size_t k = 0; k < kLanes; ++k) {
      const Vec2f at{u[k], v[k]};
      const Rgba one =
          sample(TextureTable{&textures, &images}, use, space, SurfaceInputs{&at, 1, {}, footprint[k], &density[k]});
      EXPECT_TRUE(same_bits(rgb.get(k).r, one.rgb.r) && same_bits(rgb.get(k).g, one.rgb.g) &&
                  same_bits(rgb.get(k).b, one.rgb.b) && same_bits(a[k], one.a))
          << i << " " << k;
    }
  }
}

TEST(ShadingLanes, EnvironmentsAreLookedUpToTheBit) {
  const Environment environment = studio_environment({0.3, -0.2, -1});
  Uniform uniform(4);
  for (int i = 0; i < 5000; ++i) {
    Vec3Array<F> d;
    LaneArray<F> roughness;
    for (size_t k = 0; k < kLanes; ++k) {
      d.set(k, k == 0 ? Vec3f{0, 1, 0} : uniform.direction());
      roughness[k] = k % 3 ? uniform(0, 1) : 0;
    }
    RgbArray<F> seen, diffuse;
    seen.store(environment_radiance(environment, d.load(), roughness.load()));
    diffuse.store(environment_diffuse(environment, d.load()));
    for (size_t k = 0; k < kLanes; ++k) {
      EXPECT_EQ(seen.get(k), environment_radiance(environment, d.get(k), roughness[k]));
      EXPECT_EQ(diffuse.get(k), environment_diffuse(environment, d.get(k)));
    }
  }
}

TEST(ShadingLanes, LightsAndLobesHaveTheSameBits) {
  Uniform uniform(5);
  for (int i = 0; i < 5000; ++i) {
    Light light;
    light.kind = Light::Kind(i % 3), light.intensity = {uniform(0, 5), 1, 2}, light.p_world = {1, 2, 3};
    light.range = i % 2 ? 4.0f : 0.0f, light.attenuated = i % 5 != 0;
    Vec3Array<DoubleOf<F>> p;
    Vec3Array<F> s, b;
    LaneArray<F> roughness, metallic;
    for (size_t k = 0; k < kLanes; ++k) {
      p.set(k, k == 0 ? light.p_world : Vec3d(uniform(-5, 5), uniform(-5, 5), uniform(-5, 5)));
      s.set(k, uniform.direction()), b.set(k, uniform.direction());
      roughness[k] = uniform(0, 1), metallic[k] = uniform(0, 1);
    }
    RgbArray<F> radiance, phong, schlick;
    const ArrivingLight<F> lanes = light_at<F>(light, p.load());
    radiance.store(lanes.radiance);
    const Rgb white{1.0f}, grey{0.4f};
    const Vec3f n{0, 0, 1};
    phong.store(reflected_light(BasicPhongBsdf<F>{BasicRgb<F>(grey), BasicRgb<F>(grey), white, 17, {}, {}, 1.5f, false},
                                broadcast<F>(n), s.load(), b.load()));
    const BasicSplitSum<F> split = ggx_albedo<F>(roughness.load(), metallic.load());
    schlick.store(fresnel_schlick(BasicRgb<F>(split.scale, split.bias, F(0.5f)), F(1), metallic.load()));
    for (size_t k = 0; k < kLanes; ++k) {
      EXPECT_EQ(radiance.get(k), light_at<float>(light, p.get(k)).radiance);
      EXPECT_EQ(phong.get(k),
                reflected_light(PhongBsdf{grey, grey, white, 17, {}, {}, 1.5f, false}, n, s.get(k), b.get(k)));
      const SplitSum one = ggx_albedo(roughness[k], metallic[k]);
      EXPECT_EQ(schlick.get(k), fresnel_schlick(Rgb{one.scale, one.bias, 0.5f}, 1, metallic[k]));
    }
  }
}

}  // namespace
}  // namespace alhazen
