// Claims about reflectance: integrals against closed forms, laws kept and broken, and the forms in which it is shown.
#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include "core/error.h"
#include "core/sampling.h"
#include "loaders/gltf.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"
#include "reflectance/brdf_csv.h"
#include "reflectance/brdf_html.h"
#include "reflectance/check_brdf.h"
#include "reflectance/directions.h"
#include "reflectance/drawing_picture.h"
#include "reflectance/drawing_svg.h"
#include "reflectance/hemisphere_map.h"
#include "reflectance/lobe_slice.h"
#include "reflectance/material_brdf.h"
#include "reflectance/models.h"
#include "reflectance/sheet.h"
#include "reflectance/verdicts.h"

namespace alhazen {
namespace {

constexpr double kPi = std::numbers::pi;

Subject model(const std::string& name, const ModelSettings& settings = {}) {
  for (const ReflectanceModel& m : reflectance_models())
    if (m.name == name) return m.subject(settings);
  throw std::runtime_error(name);
}

double beam(const Subject& subject, double degrees) {
  return double(beam_albedo(subject.brdf, direction_at(degrees, 0)).value.g);
}
double furnace(const Subject& subject, double degrees) {
  return double(furnace_albedo(subject.brdf, direction_at(degrees, 0)).value.g);
}

TEST(DirectionalAlbedo, OfLambertIsItsReflectanceFromEverywhere) {
  for (const double degrees : {0.0, 10.0, 45.0, 80.0, 89.0, 89.99})
    for (const float rho : {1.0f, 0.3f}) {
      const Subject lambert = model("lambert", {.diffuse = {rho, rho / 2, 0}});
      const Albedo albedo = beam_albedo(lambert.brdf, direction_at(degrees, 77));
      EXPECT_NEAR(double(albedo.value.r), double(rho), 2e-4) << degrees;
      EXPECT_NEAR(double(albedo.value.g), double(rho / 2), 2e-4) << degrees;
      EXPECT_EQ(albedo.value.b, 0);
      EXPECT_LT(albedo.error, 1e-3);
    }
}

// At the normal the lobe is r_s cos^a / pi over n·s = 1: its beam is reflected as 2 r_s / (a + 2), and an eye in a
// furnace, for whom n·s cancels, sees 2 r_s / (a + 1).
TEST(DirectionalAlbedo, OfThePhongLobeAtTheNormalHasItsClosedForm) {
  for (const float a : {1.0f, 10.0f, 50.0f, 1000.0f}) {
    const Subject phong = model("phong", {.diffuse = Rgb(0.0f), .specular = Rgb(0.7f), .shininess = a});
    EXPECT_NEAR(beam(phong, 0) * double(a + 2), 2 * 0.7, 2e-3) << a;
    EXPECT_NEAR(furnace(phong, 0) * double(a + 1), 2 * 0.7, 2e-3) << a;
  }
}

TEST(DirectionalAlbedo, OfNormalisedPhongAtTheNormalIsItsReflectance) {
  for (const float a : {1.0f, 20.0f, 300.0f, 1e5f}) {
    const Subject phong = model("normalised-phong", {.diffuse = Rgb(0.2f), .specular = Rgb(0.8f), .shininess = a});
    EXPECT_NEAR(beam(phong, 0), 1, 5e-4) << a;
    for (const double degrees : {30.0, 60.0, 89.0}) EXPECT_LT(beam(phong, degrees), 1.0005) << a << " " << degrees;
  }
}

// Alpha 1, F0 1, at the normal: D = 1 / pi, G2 / (4 n·s n·b) = 1 / (2 (1 + n·s)), so that it is 1 - ln 2.
TEST(DirectionalAlbedo, OfTheRoughestMicrofacetsAtTheNormalHasItsClosedForm) {
  EXPECT_NEAR(beam(model("ggx", {.specular = Rgb(1.0f), .roughness = 1}), 0), 1 - std::numbers::ln2, 1e-4);
}

TEST(DirectionalAlbedo, AgreesWithTheTableOfMicrofacets) {
  for (const float roughness : {0.032f, 0.1f, 0.3f, 0.6f, 1.0f})
    for (const float f0 : {0.04f, 0.5f, 1.0f})
      for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
        const Subject ggx_lobe = model("ggx", {.specular = Rgb(f0), .roughness = roughness});
        const SplitSum table = ggx_albedo(roughness, float(std::cos(degrees * kDegree)));
        EXPECT_NEAR(beam(ggx_lobe, degrees), double(f0 * table.scale + table.bias), 0.012)
            << roughness << " " << f0 << " " << degrees;
      }
}

// As alpha goes to 0, the lobe becomes a mirror that reflects as Schlick says.
TEST(DirectionalAlbedo, OfLobesOfAThousandthIsSchlicksReflectance) {
  for (const double degrees : {0.0, 20.0, 45.0, 70.0, 80.0}) {
    const Subject mirror = model("ggx", {.specular = Rgb(0.3f), .roughness = 0});
    const double expected = double(fresnel_schlick(Rgb(0.3f), 1, float(std::cos(degrees * kDegree))).g);
    EXPECT_NEAR(beam(mirror, degrees), expected, 3e-3) << degrees;
  }
}

TEST(DirectionalAlbedo, AgreesWithEvenSamplingWhereverTheLightComesFrom) {
  const Subject subjects[] = {model("gltf", {.diffuse = Rgb(0.8f), .roughness = 0.6f}),
                              model("phong", {.shininess = 8}), model("ggx", {.roughness = 0.7f, .anisotropy = 0.7f})};
  for (const Subject& subject : subjects)
    for (const double degrees : {0.0, 50.0, 85.0}) {
      constexpr int kCosines = 1000, kTurns = 1000;
      const Vec3f s = direction_at(degrees, 20);
      double sum = 0;
      for (int i = 0; i < kCosines; ++i)
        for (int k = 0; k < kTurns; ++k) {
          const double z = std::sqrt((i + 0.5) / kCosines);  // projected solid angle is even in its square
          sum += double(subject.brdf(s, direction_at(std::acos(z) / kDegree, 360 * (k + 0.5) / kTurns)).g);
        }
      EXPECT_NEAR(double(beam_albedo(subject.brdf, s).value.g), sum * kPi / (kCosines * kTurns), 2e-3)
          << subject.model << " " << degrees;
    }
}

TEST(CheckBrdf, PhysicalModelsKeepEveryLaw) {
  const Subject subjects[] = {
      model("lambert", {.diffuse = Rgb(1.0f)}),
      model("normalised-phong", {.diffuse = Rgb(0.4f), .specular = Rgb(0.6f), .shininess = 200}),
      model("ggx", {.specular = Rgb(1.0f), .roughness = 0}),
      model("ggx", {.specular = Rgb(1.0f), .roughness = 0.5f}),
      model("ggx", {.specular = Rgb(1.0f), .roughness = 0.5f, .anisotropy = 0.8f}),
      model("gltf", {.diffuse = Rgb(0.5f), .roughness = 0.4f}),
      model("gltf", {.diffuse = Rgb(1.0f), .roughness = 0.4f, .metallic = 1}),
      model("dielectric", {})};
  for (const Subject& subject : subjects) {
    const BrdfCheck check = check_brdf(subject, 0);
    EXPECT_TRUE(check.keeps_all()) << subject.model << "\n" << laws_text(subject, check);
    EXPECT_LE(check.most_beam.value, 1.002) << subject.model;
    EXPECT_EQ(summary(check), "A physical BRDF, as far as this looks.");
  }
}

TEST(CheckBrdf, MicrofacetsAreReciprocalToRounding) {
  EXPECT_LT(check_brdf(model("ggx", {.specular = Rgb(1.0f)}), 0).most_unequal.value, 1e-5);
}

// The lobe keeps its height while n·s, by which it is divided, goes to 0.
TEST(CheckBrdf, ThePhongModelGainsWithoutBoundAtGrazingAndIsNotReciprocal) {
  const Subject phong = model("phong", {.diffuse = Rgb(0.5f), .specular = Rgb(0.5f), .shininess = 10});
  const BrdfCheck check = check_brdf(phong, 0);
  EXPECT_FALSE(check.keeps_energy());
  EXPECT_FALSE(check.keeps_reciprocity());
  EXPECT_TRUE(check.keeps_positivity());
  EXPECT_EQ(check.most_beam.light, 89.99);
  // Light along the surface: half the lobe is left, whose integral has a closed form by Wallis: over the angle to the
  // mirror direction, cos^10 sin^2 from 0 to pi/2 is 21 pi / 2048, and over the half turn about it, the sine's 2.
  const double lobe = 0.5 / kPi * 2 * (21 * kPi / 2048) / std::cos(89.99 * kDegree);
  EXPECT_NEAR(check.most_beam.value, 0.5 + lobe, 0.005 * lobe);
  EXPECT_EQ(summary(check), "No physical BRDF: it breaks energy, reciprocity.");
}

TEST(CheckBrdf, AWhiteDiffuseBaseUnderGltfsCoatingGainsAtGrazing) {
  const BrdfCheck check = check_brdf(model("gltf", {.diffuse = Rgb(1.0f), .roughness = 0.5f}), 0);
  EXPECT_FALSE(check.keeps_energy());
  EXPECT_TRUE(check.keeps_reciprocity());
  EXPECT_GT(check.gains_from, 45);
}

TEST(CheckBrdf, NegativeAndInfiniteValuesAreFound) {
  Subject subject = model("lambert");
  subject.brdf = [](const Vec3f& s, const Vec3f& b) { return Rgb(dot(s, b) - 0.5f); };
  BrdfCheck check = check_brdf(subject, 0);
  EXPECT_FALSE(check.keeps_positivity());
  EXPECT_LT(check.least_value.value, -0.9);
  subject.brdf = [](const Vec3f& s, const Vec3f&) { return Rgb(s.x > 0.9f ? NAN : 0.1f); };
  check = check_brdf(subject, 0);
  EXPECT_FALSE(check.keeps_positivity());
  EXPECT_GT(check.not_finite, 100u);
  EXPECT_FALSE(check.isotropic);
}

/// A scene of one material, given as JSON.
Scene scene_of(const std::string& material) {
  const std::string text =
      R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_materials_clearcoat","KHR_materials_transmission",)"
      R"("KHR_materials_unlit","KHR_materials_sheen"],"materials":[)" +
      material + "]}";
  return load_gltf({text.begin(), text.end()}, "material.gltf", [](const std::string&) {}).scene;
}

TEST(MaterialBrdf, IsWhatTheRendererReflectsOverTheCosine) {
  const Scene scene = scene_of(
      R"({"name":"coated","pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.2,1],"metallicFactor":0.3,"roughnessFactor":0.4},)"
      R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":0.7},"KHR_materials_sheen":{"sheenColorFactor":[0.2,0.3,0.4]}}})");
  const Subject subject = material_subject(scene, 0, {0.5f, 0.5f});
  EXPECT_EQ(subject.name, "coated");
  const MetallicRoughnessBsdf bsdf = metallic_roughness_bsdf(scene.materials[0], {}, {});
  for (uint32_t i = 0; i < 500; ++i) {
    const Vec2f u = sobol_owen(i, 1), v = sobol_owen(i, 2);
    const Vec3f s = direction_at(89 * double(u.x), 360 * double(u.y)),
                b = direction_at(89 * double(v.x), 360 * double(v.y));
    const Rgb light = reflected_light(bsdf, LayerFrames(Vec3f{0, 0, 1}), s, b), value = subject.brdf(s, b) * s.z;
    EXPECT_NEAR(value.r, light.r, 1e-5f * (1 + light.r));
    EXPECT_NEAR(value.b, light.b, 1e-5f * (1 + light.b));
    EXPECT_EQ(subject.brdf(-s, b), Rgb{});
    EXPECT_EQ(subject.brdf(s, -b), Rgb{});
  }
}

// KHR_materials_clearcoat weighs the coat by the eye's angle alone.
TEST(MaterialBrdf, ClearcoatIsNotReciprocal) {
  const Scene scene =
      scene_of(R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],"metallicFactor":0},)"
               R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatRoughnessFactor":0.3}}})");
  const BrdfCheck check = check_brdf(material_subject(scene, 0, {}), 0);
  EXPECT_FALSE(check.keeps_reciprocity());
  EXPECT_TRUE(check.keeps_positivity());
}

TEST(MaterialBrdf, RaysOfSmoothGlassShareWhatComesIn) {
  const Subject glass = model("dielectric", {.ior = 1.5f});
  for (float c = 0; c <= 1; c += 0.01f) {
    const RayShares rays = glass.smooth(c);
    EXPECT_NEAR((rays.mirrored + rays.transmitted).g, 1, 1e-6f);
    EXPECT_FLOAT_EQ(rays.mirrored.g, fresnel_dielectric(c, 1 / 1.5f));
  }
}

TEST(MaterialBrdf, UnlitMaterialsReflectNothing) {
  EXPECT_THROW((void)material_subject(scene_of(R"({"extensions":{"KHR_materials_unlit":{}}})"), 0, {}), UsageError);
}

TEST(HemisphereMap, DirectionsAndPointsOfTheDiskAreOneToOneAndOfEqualArea) {
  for (uint32_t i = 0; i < 1000; ++i) {
    const Vec2f u = sobol_owen(i, 5);
    const double r = std::sqrt(double(u.x)), phi = 2 * kPi * double(u.y);
    const Vec3f d = direction_of_disk({r * std::cos(phi), r * std::sin(phi)});
    EXPECT_NEAR(double(d.z), 1 - double(u.x), 1e-6);  // solid angle is even in the height
    EXPECT_NEAR(disk_of_direction(d).x, r * std::cos(phi), 1e-5);
    EXPECT_NEAR(disk_of_direction(d).y, r * std::sin(phi), 1e-5);
  }
}

TEST(LobeSlice, MeetsTheMirrorDirectionOfNarrowLobes) {
  const Subject mirror = model("ggx", {.specular = Rgb(1.0f), .roughness = 0});
  for (const double incident : {0.0, 33.3, 80.0}) {
    const Vec3f s = direction_at(incident, 0);
    EXPECT_FLOAT_EQ(peak(lobe_slice(mirror.brdf, incident, 0)), mirror.brdf(s, mirrored(s)).g);
  }
}

TEST(BrdfCsv, RowsHoldTheValuesAtTheirAngles) {
  const Subject subject = model("ggx", {.specular = {0.9f, 0.5f, 0.1f}});
  for (const bool isotropic : {true, false}) {
    std::string csv;
    write_brdf_csv(subject.brdf, 30, isotropic, [&](std::string_view text) { csv += text; });
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "theta_i,phi_i,theta_o,phi_o,r,g,b");
    size_t rows = 0;
    for (; std::getline(lines, line); ++rows) {
      double v[7];
      ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5, v + 6),
                7);
      EXPECT_EQ(subject.brdf(direction_at(v[0], v[1]), direction_at(v[2], v[3])),
                Rgb(float(v[4]), float(v[5]), float(v[6])));
    }
    EXPECT_EQ(double(rows), brdf_csv_rows(30, isotropic));
    EXPECT_EQ(rows, isotropic ? 3u * 3 * 12 : 3u * 12 * 3 * 12);
  }
}

/// Without the letters of pictures, which may spell anything.
std::string without_pictures(std::string svg) {
  for (size_t at = svg.find("base64,"); at != std::string::npos; at = svg.find("base64,", at + 1))
    svg.erase(at + 7, svg.find('"', at) - at - 7);
  return svg;
}

size_t count(const std::string& text, const std::string& word) {
  size_t n = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++n;
  return n;
}

TEST(BrdfSheet, NamesCannotBreakIt) {
  Subject subject = model("phong");
  subject.name = "<script>&\"\x01</text>";
  const BrdfReport report = brdf_report(subject, {});
  for (const std::string& form : {drawing_svg(brdf_sheet(report)), brdf_html(report)}) {
    EXPECT_EQ(form.find("<script>&"), std::string::npos);
    EXPECT_EQ(count(form, "<text"), count(form, "</text>"));
    EXPECT_EQ(count(form, "<g "), count(form, "</g>"));
    EXPECT_EQ(without_pictures(form).find("nan"), std::string::npos);
  }
}

TEST(BrdfSheet, EveryModelHasOneEvenWhereNothingIsReflected) {
  for (const ReflectanceModel& m : reflectance_models()) {
    ModelSettings nothing{.diffuse = Rgb(0.0f), .specular = Rgb(0.0f)};
    for (const ModelSettings& settings : {ModelSettings{}, nothing}) {
      const Drawing sheet = brdf_sheet(brdf_report(m.subject(settings), {.incident = {0, 45, 89.9}}));
      EXPECT_EQ(without_pictures(drawing_svg(sheet)).find("nan"), std::string::npos) << m.name;
      const ColorImage picture = drawing_picture(sheet, 1);
      for (const float v : picture.pixels) ASSERT_TRUE(v >= 0 && v <= 1.0001f) << m.name << " " << v;
    }
  }
}

TEST(Drawing, FilledShapesCoverTheirArea) {
  const Drawing drawing{40, 40, {circle({20.3, 19.6}, 12, kNoInk, {0, 0, 0})}};
  const ColorImage picture = drawing_picture(drawing, 1);
  double dark = 0;
  for (size_t i = 0; i < picture.pixels.size(); i += 4) {
    const double v = double(picture.pixels[i]);
    dark += 1 - (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
  }
  EXPECT_NEAR(dark, kPi * 144, 1.5);
}

}  // namespace
}  // namespace alhazen
