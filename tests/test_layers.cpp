// Lobes and layers of glTF's material extensions against integrals and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "materials/fresnel.h"
#include "materials/metallic_roughness.h"
#include "materials/thin_film.h"

namespace alhazen {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Vec3f direction(float theta, float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The integral of f(direction to the light) over the hemisphere about +z by solid angle.
template <class Function>
double over_hemisphere(const Function& f) {
  constexpr int kRows = 300, kColumns = 300;
  double sum = 0;
  for (int i = 0; i < kRows; ++i)
    for (int k = 0; k < kColumns; ++k) {
      const float theta = (float(i) + 0.5f) / kRows * kPi / 2, phi = (float(k) + 0.5f) / kColumns * 2 * kPi;
      sum += double(f(direction(theta, phi)) * std::sin(theta));
    }
  return sum * double(kPi / 2 / kRows) * double(2 * kPi / kColumns);
}

const LayerFrames kUp{Vec3f{0, 0, 1}};

double albedo(const Material& material, const Vec3f& b) {
  const MetallicRoughnessBsdf bsdf = metallic_roughness_bsdf(material, {}, {});
  return over_hemisphere([&](const Vec3f& s) { return reflected_light(bsdf, kUp, s, b).g; });
}

TEST(Ggx, DrawnOutByNothingIsTheRoundLobe) {
  const ShadingFrame frame = frame_about(normalize(Vec3f{0.3f, -0.5f, 0.8f}));
  const Vec3f s = normalize(frame.n + 0.3f * frame.t), b = normalize(frame.n - 0.8f * frame.b);
  const Vec3f h = normalize(s + b);
  const Alpha round = alpha_of(0.6f);
  EXPECT_EQ(round.t, round.b);
  const Alpha nearly{round.t * 1.00001f, round.b};
  EXPECT_NEAR(ggx(nearly, frame, s, b, h) / ggx(round, frame, s, b, h), 1, 1e-4f);
}

TEST(Ggx, FacetsOfAnyAnisotropyCoverTheSurfaceOnce) {
  // The projected area of all facets is that of the surface: seen from above, D is ggx with s = b = n, but for V.
  const ShadingFrame frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Alpha alpha : {Alpha{0.3f, 0.3f}, Alpha{0.8f, 0.3f}, Alpha{1.0f, 0.2f}}) {
    const double area = over_hemisphere([&](const Vec3f& h) {
      const float visibility = 0.25f;  // of s = b = n
      return ggx(alpha, frame, frame.n, frame.n, h) / visibility * h.z;
    });
    EXPECT_NEAR(area, 1, 5e-3) << alpha.t << " " << alpha.b;
  }
}

TEST(Ggx, AlbedoTableAgreesWithTheIntegral) {
  for (float roughness : {0.3f, 0.5f, 0.8f, 1.0f})
    for (float theta : {0.1f, 0.7f, 1.2f}) {
      Material m;
      m.metallic = 1, m.roughness = roughness;
      m.base_color.rgb = Rgb{0.5f};
      const MetallicRoughnessBsdf bsdf = metallic_roughness_bsdf(m, {}, {});
      EXPECT_NEAR(double(specular_albedo(bsdf, std::cos(theta)).g), albedo(m, direction(theta, 0)), 0.012)
          << roughness << " " << theta;
    }
}

TEST(Ggx, AlbedoOfASmoothSurfaceIsFresnels) {
  for (float cos_theta : {0.2f, 0.5f, 0.9f}) {
    const SplitSum split = ggx_albedo(0, cos_theta);
    const float expected = fresnel_schlick(Rgb{0.04f}, 1, cos_theta).r;
    EXPECT_NEAR(0.04f * split.scale + split.bias, expected, 0.01f);
  }
}

TEST(Sheen, AlbedoTableAgreesWithTheIntegral) {
  for (float roughness : {0.3f, 0.6f, 1.0f})
    for (float theta : {0.1f, 0.7f, 1.2f}) {
      const Vec3f b = direction(theta, 0);
      const double expected =
          over_hemisphere([&](const Vec3f& s) { return charlie(roughness, s.z, b.z, normalize(s + b).z) * s.z; });
      EXPECT_NEAR(double(charlie_albedo(roughness, b.z)), expected, 0.012) << roughness << " " << theta;
    }
}

TEST(Sheen, TakesFromTheBaseWhatItReflects) {
  Material m;
  m.metallic = 0, m.specular = 0;
  m.base_color.rgb = Rgb{1.0f};
  m.sheen.color = Rgb{1.0f};
  for (float roughness : {0.3f, 0.7f, 1.0f})
    for (float theta : {0.1f, 0.8f}) {
      m.sheen.roughness = roughness;
      EXPECT_LE(albedo(m, direction(theta, 0)), 1.01) << roughness << " " << theta;
      EXPECT_GE(albedo(m, direction(theta, 0)), 0.8) << roughness << " " << theta;
    }
}

TEST(Clearcoat, LeavesTheRestToTheBase) {
  Material m;
  m.metallic = 0, m.specular = 0;
  m.base_color.rgb = Rgb{1.0f};
  m.clearcoat.factor = 1, m.clearcoat.roughness = 0.5f;
  const Vec3f b = direction(0.4f, 0);
  const MetallicRoughnessBsdf bsdf = metallic_roughness_bsdf(m, {}, {});
  const float kept = coat_reflectance(bsdf, {0, 0, 1}, b);
  EXPECT_NEAR(kept, fresnel_schlick(Rgb{0.04f}, 1, b.z).r, 1e-6f);
  EXPECT_FLOAT_EQ(layers_transmittance(bsdf, kUp, b), 1 - kept);
  EXPECT_FLOAT_EQ(diffuse_albedo(bsdf, kUp, b).front.g, 1 - kept);
  EXPECT_LE(albedo(m, b), 1.005);
  m.clearcoat.factor = 0;
  EXPECT_EQ(coat_reflectance(metallic_roughness_bsdf(m, {}, {}), {0, 0, 1}, b), 0);
}

TEST(Clearcoat, HasANormalOfItsOwn) {
  Material m;
  m.metallic = 0, m.specular = 0;
  m.base_color.rgb = Rgb{0.0f};
  m.clearcoat.factor = 1, m.clearcoat.roughness = 0.3f;
  const MetallicRoughnessBsdf bsdf = metallic_roughness_bsdf(m, {}, {});
  LayerFrames tilted = kUp;
  tilted.coat_n = direction(0.3f, 0);
  // The highlight stands where the coat mirrors the light, not where the base would.
  const Vec3f b{0, 0, 1};
  EXPECT_GT(reflected_light(bsdf, tilted, direction(0.6f, 0), b).g,
            10 * reflected_light(bsdf, tilted, direction(0.6f, kPi), b).g);
}

TEST(ThinFilm, WithoutThicknessIsTheBareSurface) {
  for (float cos_theta : {0.2f, 0.6f, 1.0f})
    for (float f0 : {0.02f, 0.04f, 0.5f, 0.9f}) {
      const Rgb film = thin_film_fresnel(cos_theta, 1.3f, 0, Rgb{f0});
      const Rgb bare = fresnel_schlick(Rgb{f0}, 1, cos_theta);
      EXPECT_EQ(film, bare) << cos_theta << " " << f0;
    }
}

TEST(ThinFilm, StaysBetweenNothingAndAllAndChangesColourWithTheAngle) {
  for (float thickness = 0; thickness <= 1200; thickness += 50)
    for (float cos_theta = 0; cos_theta <= 1; cos_theta += 0.1f) {
      const Rgb c = thin_film_fresnel(cos_theta, 1.33f, thickness, {0.04f, 0.5f, 0.95f});
      ASSERT_TRUE(is_finite(c));
      ASSERT_LE(max_component(c), 1);
      ASSERT_GE(std::min({c.r, c.g, c.b}), 0);
    }
  const Rgb head_on = thin_film_fresnel(1, 1.8f, 400, Rgb{0.04f}),
            aside = thin_film_fresnel(0.4f, 1.8f, 400, Rgb{0.04f});
  EXPECT_GT(std::abs(head_on.r / head_on.b - aside.r / aside.b), 0.1f);
}

TEST(DiffuseTransmission, SharesTheDiffuseLightBetweenBothSides) {
  Material m;
  m.metallic = 0, m.specular = 0;
  m.base_color.rgb = Rgb{0.8f};
  m.diffuse_transmission.factor = 0.25f;
  m.diffuse_transmission.color = Rgb{0.4f};
  const MetallicRoughnessBsdf bsdf = metallic_roughness_bsdf(m, {}, {});
  const Vec3f b{0, 0, 1}, s = direction(0.5f, 1);
  EXPECT_NEAR(reflected_light(bsdf, kUp, s, b).g, 0.75f * 0.8f / kPi * s.z, 1e-6f);
  EXPECT_NEAR(reflected_light(bsdf, kUp, -s, b).g, 0.25f * 0.4f / kPi * s.z, 1e-6f);
  const DiffuseAlbedo diffuse = diffuse_albedo(bsdf, kUp, b);
  EXPECT_FLOAT_EQ(diffuse.front.g, 0.6f);
  EXPECT_FLOAT_EQ(diffuse.back.g, 0.1f);
}

TEST(Anisotropy, DrawsTheHighlightOutAlongItsDirection) {
  Material m;
  m.metallic = 1, m.roughness = 0.4f;
  m.anisotropy.strength = 1;
  const MetallicRoughnessBsdf bsdf = metallic_roughness_bsdf(m, {}, {});
  LayerFrames frames = kUp;
  frames.base = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Vec3f b{0, 0, 1};
  EXPECT_GT(reflected_light(bsdf, frames, direction(0.8f, 0), b).g,
            5 * reflected_light(bsdf, frames, direction(0.8f, kPi / 2), b).g);
}

}  // namespace
}  // namespace alhazen
