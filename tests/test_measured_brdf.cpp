// Claims about measured BRDFs: angles, tables, and what is made of them.
#include "materials/measured_brdf.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "measured_files.h"
#include "trials.h"

namespace alhazen {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr Vec3f kUp{0, 0, 1};

class Random {
 public:
  float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(generator_); }
  /// Uniform over directions whose cosine with z is at least `least`.
  Vec3f direction(float least = 0) {
    const float z = between(least, 1), phi = between(0, 2 * kPi), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  RusinkiewiczAngles angles() { return {between(0, kPi / 2), between(0, kPi / 2), between(0, kPi)}; }

 private:
  std::mt19937 generator_{20};
};

float relative_difference(const Rgb& found, const Rgb& expected, float floor) {
  const auto of = [&](float a, float b) { return std::abs(a - b) / std::max(std::abs(b), floor); };
  return std::max({of(found.r, expected.r), of(found.g, expected.g), of(found.b, expected.b)});
}

// ---- Angles ----

TEST(Rusinkiewicz, DirectionsHaveTheAnglesTheyWereMadeOf) {
  Random random;
  for (int i = 0; i < trials(100000); ++i) {
    const RusinkiewiczAngles made = random.angles();
    const DirectionPair pair = directions(made);
    const RusinkiewiczAngles found = rusinkiewicz(kUp, pair.s, pair.b);
    // Directions that are nearly opposite leave little of their sum; around a pole the turn is as uncertain as the pole
    // is near.
    const float turn = std::abs(found.phi_d - made.phi_d), left = std::cos(made.theta_d);
    EXPECT_LE(std::abs(found.theta_h - made.theta_h) * left, 1e-6f);
    EXPECT_NEAR(found.theta_d, made.theta_d, 1e-6);
    EXPECT_LE(std::min(turn, kPi - turn) * std::sin(made.theta_h) * std::sin(made.theta_d) * left, 1e-6f);
  }
}

/// As MERL's reader has them: the light's direction turned back by the half vector's azimuth, then by its polar angle.
RusinkiewiczAngles by_rotations(const Vec3f& s, const Vec3f& b) {
  const Vec3d h = normalize(Vec3d(s) + Vec3d(b)), in(s);
  const double theta = std::acos(h.z), phi = std::atan2(h.y, h.x);
  const Vec3d about_z{std::cos(phi) * in.x + std::sin(phi) * in.y, std::cos(phi) * in.y - std::sin(phi) * in.x, in.z};
  const Vec3d diff{std::cos(theta) * about_z.x - std::sin(theta) * about_z.z, about_z.y,
                   std::sin(theta) * about_z.x + std::cos(theta) * about_z.z};
  double phi_d = std::atan2(diff.y, diff.x);
  if (phi_d < 0) phi_d += std::numbers::pi;
  return {float(theta), float(std::acos(std::min(1.0, diff.z))), float(phi_d)};
}

TEST(Rusinkiewicz, AnglesAreThoseOfTheDefinitionByRotations) {
  Random random;
  for (int i = 0; i < trials(100000); ++i) {
    const Vec3f s = random.direction(), b = random.direction();
    const RusinkiewiczAngles found = rusinkiewicz(kUp, s, b), expected = by_rotations(s, b);
    EXPECT_NEAR(found.theta_h, expected.theta_h, 1e-5);
    EXPECT_NEAR(found.theta_d, expected.theta_d, 1e-4);  // its cosine has lost digits
    const float turn = std::abs(found.phi_d - expected.phi_d);
    EXPECT_LE(std::min(turn, kPi - turn) * std::sin(expected.theta_h) * std::sin(expected.theta_d), 1e-5f);
  }
}

TEST(Rusinkiewicz, SwappedDirectionsGiveTheSameBits) {
  Random random;
  for (int i = 0; i < trials(100000); ++i) {
    const Vec3f n = random.direction(-1), s = random.direction(-1), b = random.direction(-1);
    const RusinkiewiczAngles there = rusinkiewicz(n, s, b), back = rusinkiewicz(n, b, s);
    EXPECT_EQ(there.theta_h, back.theta_h);
    EXPECT_EQ(there.theta_d, back.theta_d);
    EXPECT_EQ(there.phi_d, back.phi_d);
  }
}

// ---- Tables ----

MeasuredTable random_table(const MeasuredGrid& grid, Random& random) {
  MeasuredTable table{grid, {}};
  for (size_t i = 0; i < grid.size(); ++i)
    table.values.push_back({random.between(0, 1), random.between(0, 1), random.between(0, 1)});
  return table;
}

TEST(MeasuredTable, EntriesAreMetInTheMiddlesOfTheirCells) {
  Random random;
  const MeasuredGrid grid{7, 5, 6};
  const MeasuredTable table = random_table(grid, random);
  int met = 0;
  for (int h = 0; h < grid.theta_h; ++h)
    for (int d = 0; d < grid.theta_d; ++d)
      for (int p = 0; p < grid.phi_d; ++p) {
        const DirectionPair pair = directions(cell_middle(grid, h, d, p));
        if (pair.s.z <= 0 || pair.b.z <= 0) continue;
        const Rgb entry = table.values[size_t((h * grid.theta_d + d) * grid.phi_d + p)];
        EXPECT_LE(relative_difference(evaluate(table, kUp, pair.s, pair.b), entry, 1), 1e-4f);
        ++met;
      }
  EXPECT_GT(met, 80);
}

TEST(MeasuredTable, LambertComesBackEverywhere) {
  Random random;
  MeasuredTable table = table_of(lambert_brdf({0.2f, 0.5f, 0.8f}), {20, 20, 20});
  fill_gaps(table);
  for (int i = 0; i < trials(100000); ++i) {
    const Rgb f = evaluate(table, kUp, random.direction(), random.direction());
    EXPECT_LE(relative_difference(f * kPi, {0.2f, 0.5f, 0.8f}, 0), 1e-6f);
  }
}

struct Smooth {
  const char* name;
  Brdf brdf;
  float error;  // relative to the value, or to 0.01 1/sr where it is less
};

TEST(MeasuredTable, InterpolatesInMerlsSizeWithinTheStatedError) {
  const Smooth cases[] = {{"ggx 0.5", ggx_brdf({0.3f, 0.2f, 0.1f}, Rgb{0.04f}, 0.5f), 0.015f},
                          {"ggx 0.2", ggx_brdf({0.3f, 0.2f, 0.1f}, {0.9f, 0.6f, 0.3f}, 0.2f), 0.04f},
                          {"ward 0.2", ward_brdf({0.1f, 0.2f, 0.3f}, Rgb{0.3f}, 0.2f), 0.02f}};
  Random random;
  for (const Smooth& c : cases) {
    MeasuredTable table = table_of(c.brdf);
    fill_gaps(table);
    float worst = 0;
    for (int i = 0; i < trials(100000); ++i) {
      const Vec3f s = random.direction(0.1f), b = random.direction(0.1f);
      worst = std::max(worst, relative_difference(evaluate(table, kUp, s, b), c.brdf(s, b), 0.01f));
    }
    EXPECT_LE(worst, c.error) << c.name;
  }
}

TEST(MeasuredTable, SwappedDirectionsAndTurnedFramesChangeNothing) {
  Random random;
  const MeasuredTable table = random_table({9, 8, 10}, random);
  for (int i = 0; i < trials(100000); ++i) {
    const Vec3f s = random.direction(), b = random.direction();
    const Rgb f = evaluate(table, kUp, s, b);
    EXPECT_EQ(f, evaluate(table, kUp, b, s));
    const auto turned = [](const Vec3f& v) { return Vec3f{v.z, v.x, v.y}; };
    EXPECT_LE(relative_difference(evaluate(table, turned(kUp), turned(s), turned(b)), f, 1), 1e-3f);
  }
}

TEST(MeasuredTable, HasNoSeams) {
  Random random;
  const MeasuredTable table = random_table({9, 8, 10}, random);
  const auto at = [&](const RusinkiewiczAngles& angles) {
    const DirectionPair pair = directions(angles);
    return evaluate(table, kUp, pair.s, pair.b);
  };
  constexpr float kStep = 1e-4f;
  for (int i = 0; i < trials(20000); ++i) {
    // Where phi_d begins anew, and where theta_d goes through 0 to the other side.
    const float h = random.between(0.02f, 0.6f), d = random.between(0, 0.9f), p = random.between(0, kPi);
    EXPECT_LE(relative_difference(at({h, d, kStep}), at({h, d, kPi - kStep}), 1), 1e-2f);
    EXPECT_LE(relative_difference(at({h, kStep, p}), at({h, kStep, std::fmod(p + kPi, kPi)}), 1), 1e-2f);
    // Between cells.
    EXPECT_LE(relative_difference(at({h, d, p}), at({h + kStep, d + kStep, p + kStep}), 1), 2e-2f);
  }
}

TEST(MeasuredTable, GapsTakeTheirNearestNeighboursValues) {
  Random random;
  MeasuredTable table = table_of(lambert_brdf(Rgb{0.5f}), {12, 12, 12});
  for (Rgb& value : table.values)
    if (random.between(0, 1) < 0.9f) value = Rgb{-1};
  const size_t known = size_t(std::ranges::count_if(table.values, [](const Rgb& v) { return v.r >= 0; }));
  EXPECT_EQ(fill_gaps(table), known);
  for (const Rgb& value : table.values) EXPECT_NEAR(value.r * kPi, 0.5f, 1e-5f);

  MeasuredTable row{{1, 1, 6}, {Rgb{1}, Rgb{-1}, Rgb{-1}, Rgb{4}, Rgb{-1}, Rgb{-1}}};
  EXPECT_EQ(fill_gaps(row), 2u);
  EXPECT_EQ(row.values[1].r, 1);
  EXPECT_EQ(row.values[2].r, 4);
  EXPECT_EQ(row.values[5].r, 1);  // around the end
}

TEST(MeasuredTable, IsDarkBelowTheHorizonAndFiniteAtIt) {
  Random random;
  const MeasuredTable table = random_table({9, 8, 10}, random);
  for (int i = 0; i < trials(100000); ++i) {
    const Vec3f s = random.direction(-1), b = random.direction(-1);
    const Rgb f = evaluate(table, kUp, s, b);
    EXPECT_EQ(f == Rgb{}, s.z <= 0 || b.z <= 0);
    EXPECT_LE(max_component(f), 1.0001f);
  }
  const Vec3f grazing = normalize(Vec3f{1, 0, 1e-7f});
  EXPECT_TRUE(is_finite(evaluate(table, kUp, grazing, {-grazing.x, 0, grazing.z})));
  EXPECT_TRUE(is_finite(evaluate(table, kUp, kUp, kUp)));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(evaluate(table, kUp, {nan, nan, nan}, kUp), Rgb{});
}

// ---- Light without a place ----

TEST(MeasuredBrdf, AlbedoOfLambertIsItsColour) {
  const Rgb color{0.2f, 0.5f, 0.8f};
  const MeasuredBrdf brdf = make_measured_brdf(table_of(lambert_brdf(color), {30, 30, 30}));
  for (float cosine = 0; cosine <= 1; cosine += 0.05f) {
    const MeasuredAlbedo albedo = measured_albedo({&brdf}, cosine);
    EXPECT_LE(relative_difference(albedo.total(), color, 0), 1e-5f);
    EXPECT_LE(relative_difference(albedo.diffuse, color, 0), 1e-5f);
  }
  EXPECT_EQ(brdf.roughness, 1);
}

TEST(MeasuredBrdf, AlbedoOfGgxIsThatOfTheRenderersOwnTable) {
  for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f}) {
    const MetallicRoughnessBsdf bsdf = ggx_bsdf(Rgb{0}, {0.9f, 0.5f, 0.1f}, roughness);
    const MeasuredBrdf brdf = make_measured_brdf(table_of(ggx_brdf(Rgb{0}, {0.9f, 0.5f, 0.1f}, roughness)));
    for (float cosine = 0.1f; cosine <= 1; cosine += 0.1f) {
      const Rgb found = measured_albedo({&brdf}, cosine).total(), expected = specular_albedo(bsdf, cosine);
      // Lobes grow towards the horizon: there they are below the chords of their table.
      EXPECT_NEAR(found.r, expected.r, 0.02f + 0.002f / cosine) << roughness << " at " << cosine;
      EXPECT_NEAR(found.b, expected.b, 0.02f + 0.002f / cosine) << roughness << " at " << cosine;
    }
  }
}

TEST(MeasuredBrdf, FindsTheRoughnessOfGgxAndTheDiffuseLightBelowIt) {
  for (const float roughness : {0.1f, 0.2f, 0.3f, 0.4f}) {
    const Rgb diffuse{0.4f, 0.3f, 0.2f};
    const MeasuredBrdf brdf = make_measured_brdf(table_of(ggx_brdf(diffuse, Rgb{0.04f}, roughness)));
    EXPECT_NEAR(brdf.roughness, roughness, 0.05f * roughness);
    EXPECT_LE(relative_difference(brdf.diffuse * kPi, diffuse, 0), 0.1f) << roughness;
  }
}

TEST(MeasuredBrdf, HighlightAndDiffuseLightAreAllTheLight) {
  Random random;
  const MeasuredBrdf brdf = make_measured_brdf(table_of(ward_brdf(Rgb{0.3f}, Rgb{0.4f}, 0.3f), {30, 30, 30}));
  const MeasuredBsdf all{&brdf, 2}, highlight{&brdf, 2, true};
  for (int i = 0; i < trials(10000); ++i) {
    const Vec3f s = random.direction(), b = random.direction();
    const float f = reflected_light(all, kUp, s, b).r, above = reflected_light(highlight, kUp, s, b).r;
    EXPECT_NEAR(f, 2 * evaluate(brdf.table, kUp, s, b).r * s.z, 1e-5f * f);
    EXPECT_LE(above, f);
    EXPECT_LE(f - above, 2 * brdf.diffuse.r * s.z + 1e-6f);
  }
}

}  // namespace
}  // namespace alhazen
