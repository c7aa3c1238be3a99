// Claims about fits: what a model made is found again, whatever lies between.
#include "reflectance/fit_brdf.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <span>

#include "loaders/measured_file.h"
#include "materials/phong.h"
#include "measured_files.h"

namespace alhazen {
namespace {

void expect_near(const Rgb& found, const Rgb& expected, float relative, float absolute, const std::string& what) {
  EXPECT_NEAR(found.r, expected.r, relative * expected.r + absolute) << what;
  EXPECT_NEAR(found.g, expected.g, relative * expected.g + absolute) << what;
  EXPECT_NEAR(found.b, expected.b, relative * expected.b + absolute) << what;
}

/// The BRDF after it went through a MERL file.
Brdf through_merl(const Brdf& brdf, float noise = 0) {
  const std::string file = merl_bytes(table_of(brdf), noise);
  LoadBudget budget;
  budget.take_file("x", file.size());
  const auto measured = std::make_shared<const MeasuredBrdf>(
      parse_measured_brdf(std::span(reinterpret_cast<const uint8_t*>(file.data()), file.size()), "x", budget));
  return [measured](const Vec3f& s, const Vec3f& b) { return evaluate(measured->table, {0, 0, 1}, s, b); };
}

Brdf phong_brdf(const Rgb& diffuse, const Rgb& specular, float shininess) {
  PhongBsdf bsdf{};
  bsdf.diffuse = diffuse, bsdf.specular = specular, bsdf.shininess = shininess;
  return [bsdf](const Vec3f& s, const Vec3f& b) {
    return s.z > 0 && b.z > 0 ? reflected_light(bsdf, {0, 0, 1}, s, b) * (1 / s.z) : Rgb{};
  };
}

TEST(FitBrdf, FindsTheParametersOfGgxAgainInAMerlFile) {
  struct Case {
    Rgb diffuse, f0;
    float roughness;
  };
  for (const Case& c :
       {Case{{0.5f, 0.3f, 0.1f}, Rgb{0.04f}, 0.1f}, Case{{0.5f, 0.3f, 0.1f}, Rgb{0.04f}, 0.3f},
        Case{{0.2f, 0.4f, 0.6f}, {0.1f, 0.2f, 0.3f}, 0.6f}, Case{{0.001f, 0.001f, 0.001f}, {0.95f, 0.64f, 0.54f}, 0.2f},
        Case{{0.02f, 0.02f, 0.02f}, {0.9f, 0.9f, 0.9f}, 0.85f}}) {
    const BrdfFit fit = fit_brdf(through_merl(ggx_brdf(c.diffuse, c.f0, c.roughness)), FitModel::ggx);
    const std::string what = "roughness " + std::to_string(c.roughness);
    EXPECT_NEAR(fit.material.roughness, c.roughness, 0.002f * c.roughness) << what;
    expect_near(fit.material.base_color.rgb, c.diffuse, 0.005f, 0.001f, what);
    expect_near(fit.material.specular_color, c.f0, 0.005f, 0.001f, what);
    EXPECT_LE(fit.residual.relative, 0.001) << what;
  }
}

TEST(FitBrdf, FindsTheParametersOfPhongAgainInAMerlFile) {
  for (const float shininess : {8.0f, 60.0f, 400.0f}) {
    const Rgb diffuse{0.2f, 0.1f, 0.05f}, specular{0.5f, 0.6f, 0.7f};
    const BrdfFit fit = fit_brdf(through_merl(phong_brdf(diffuse, specular, shininess)), FitModel::phong);
    EXPECT_NEAR(fit.material.phong.shininess, shininess, 0.005f * shininess);
    expect_near(fit.material.phong.diffuse, diffuse, 0.005f, 0.0005f, std::to_string(shininess));
    expect_near(fit.material.phong.specular, specular, 0.005f, 0.0005f, std::to_string(shininess));
    EXPECT_LE(fit.residual.relative, 0.001);
  }
}

TEST(FitBrdf, NoiseOfTenPercentMovesParametersByAFewAtMost) {
  const Rgb diffuse{0.5f, 0.3f, 0.1f}, f0{0.1f, 0.2f, 0.3f};
  const BrdfFit fit = fit_brdf(through_merl(ggx_brdf(diffuse, f0, 0.25f), 0.1f), FitModel::ggx);
  EXPECT_NEAR(fit.material.roughness, 0.25f, 0.02f * 0.25f);
  expect_near(fit.material.base_color.rgb, diffuse, 0.03f, 0, "diffuse");
  expect_near(fit.material.specular_color, f0, 0.03f, 0, "F0");
  EXPECT_GT(fit.residual.relative, 0.02);
  EXPECT_LT(fit.residual.relative, 0.12);
}

TEST(FitBrdf, ResidualIsThatOfTheFittedModelAndTellsModelsApart) {
  const Brdf ward = ward_brdf({0.2f, 0.3f, 0.4f}, Rgb{0.3f}, 0.2f), ggx = ggx_brdf({0.2f, 0.3f, 0.4f}, Rgb{0.3f}, 0.4f);
  const FitResidual right = fit_brdf(ggx, FitModel::ggx).residual, wrong = fit_brdf(ggx, FitModel::phong).residual,
                    near = fit_brdf(ward, FitModel::ggx).residual;
  EXPECT_LT(right.relative, 1e-3);
  EXPECT_GT(wrong.relative, 0.05);
  EXPECT_GT(near.relative, 0.01);
  EXPECT_GT(right.pairs, 2000);
  const BrdfFit again = fit_brdf(fitted_brdf(fit_brdf(ward, FitModel::ggx)), FitModel::ggx);
  EXPECT_LT(again.residual.relative, 1e-3);
}

TEST(FitBrdf, GivesTheSameBitsAgain) {
  const Brdf ward = ward_brdf({0.2f, 0.3f, 0.4f}, Rgb{0.3f}, 0.2f);
  const BrdfFit one = fit_brdf(ward, FitModel::phong), other = fit_brdf(ward, FitModel::phong);
  EXPECT_EQ(one.material.phong.shininess, other.material.phong.shininess);
  EXPECT_EQ(one.residual.rms, other.residual.rms);
}

TEST(FitBrdf, MaterialsAreGltf) {
  const Rgb diffuse{0.5f, 0.3f, 0.1f};
  const BrdfFit fit = fit_brdf(ggx_brdf(diffuse, Rgb{0.04f}, 0.3f), FitModel::ggx);
  const auto json = nlohmann::json::parse(fitted_material_json(fit, "paint"));
  EXPECT_EQ(json["name"], "paint");
  EXPECT_NEAR(json["pbrMetallicRoughness"]["roughnessFactor"], 0.3, 1e-3);
  EXPECT_EQ(json["extensions"]["KHR_materials_ior"]["ior"], 0);
  EXPECT_NEAR(json["extensions"]["KHR_materials_specular"]["specularColorFactor"][1], 0.04, 1e-3);
  const auto phong = nlohmann::json::parse(fitted_material_json(fit_brdf(lambert_brdf(diffuse), FitModel::phong), "x"));
  const auto& fields = phong["extensions"]["ALHAZEN_materials_phong"];
  EXPECT_NEAR(fields["diffuseFactor"][0], 0.5 / std::numbers::pi, 1e-3);
  EXPECT_NEAR(fields["ambientFactor"][0], 0.5, 3e-3);
}

}  // namespace
}  // namespace alhazen
