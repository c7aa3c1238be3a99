#include <gtest/gtest.h>

#include <cmath>

#include "crosscheck/ball.h"
#include "crosscheck/crosscheck.h"
#include "crosscheck/plugin.h"

namespace alhazen::crosscheck {
namespace {

const Family& family_named(const std::string& name) {
  for (const Family& family : built_in_families())
    if (family.name == name) return family;
  throw std::invalid_argument(name);
}

std::vector<Case> cases_of(const std::string& family, Population population, const Options& options) {
  std::vector<Case> cases;
  Observer observer;
  observer.judged = [&](const Case& c) {
    cases.push_back(c);
    cases.back().subject = nullptr;
  };
  (void)check(family_named(family), population, options, observer);
  return cases;
}

Rational exact_value(double x) { return exact(x); }
Rational exact_value(const DoubleDouble& x) { return exact(x.hi) + exact(x.lo); }

template <class N>
class BallOf : public testing::Test {};
using Midpoints = testing::Types<double, DoubleDouble>;
TYPED_TEST_SUITE(BallOf, Midpoints);

TYPED_TEST(BallOf, HoldsTheExactResultOfRandomExpressions) {
  using B = Ball<TypeParam>;
  Random random{1};
  for (int k = 0; k < 4000; ++k) {
    const double a = random.uniform() * random.decades(-9, 9), b = random.uniform(), c = random.uniform(1, 2);
    const B ball = (B(a) * B(b) - B(c)) / B(c) + B(a);
    const Rational truth = (exact(a) * exact(b) - exact(c)) / exact(c) + exact(a);
    EXPECT_LE(abs(Rational(truth - exact_value(ball.mid))), exact(ball.rad));
    EXPECT_LT(ball.rad, 64 * kUnitRoundoff<TypeParam> * (std::abs(a) + 1));
    const B root = square_root(B(std::abs(a)));
    const Rational lower = exact_value(root.mid) - exact(root.rad), upper = exact_value(root.mid) + exact(root.rad);
    EXPECT_TRUE(lower * lower <= exact(std::abs(a)) && exact(std::abs(a)) <= upper * upper);
  }
}

TYPED_TEST(BallOf, HoldsTheRationalItIsMadeOf) {
  Random random{2};
  for (int k = 0; k < 2000; ++k) {
    const Rational x = exact(random.uniform()) / exact(random.decades(-9, 9));
    const Ball<TypeParam> ball(x);
    EXPECT_LE(abs(Rational(x - exact_value(ball.mid))), exact(ball.rad));
  }
}

TYPED_TEST(BallOf, RefusesToSayWhatItDoesNotKnow) {
  using B = Ball<TypeParam>;
  EXPECT_EQ(sign(B(0.0)), 0);
  EXPECT_EQ(sign(B(1.0) - B(1.0)), 0);
  const B third = B(1.0) / B(3.0);
  EXPECT_THROW((void)sign(third * B(3.0) - B(1.0)), InDoubt);
  EXPECT_THROW((void)(B(1.0) / B(0.0)), InDoubt);
  EXPECT_THROW((void)sign(B(std::nan(""))), InDoubt);
  EXPECT_THROW((void)sign(B(1e300) * B(1e300)), InDoubt);
  EXPECT_THROW((void)to_float(B(1 + 0x1p-24) * third * B(3.0)), InDoubt);
}

TEST(DoubleDouble, RoundsToFloatOnce) {
  const double tie = 1 + 0x1p-24;  // between two floats
  EXPECT_EQ(float(DoubleDouble(tie, 0x1p-80)), 1 + 0x1p-23f);
  EXPECT_EQ(float(DoubleDouble(tie, -0x1p-80)), 1.0f);
  EXPECT_EQ(float(DoubleDouble(tie)), 1.0f);
  EXPECT_EQ(float(DoubleDouble(-tie, -0x1p-80)), -1 - 0x1p-23f);
}

TEST(Crosscheck, TheJudgesTwoInstancesAgreeOnEveryKindOfRay) {
  for (const Family& family : built_in_families())
    for (int p = 0; p < int(Population::camera); ++p) {
      Random random{3, uint64_t(p)};
      for (int subject_number = 0; subject_number < 2; ++subject_number) {
        const auto population = Population(p);
        const Subject subject = family.subject(0, population == Population::lattice, random);
        const Judge judge(subject);
        const RayMaker maker(subject, judge);
        for (int k = 0; k < 20; ++k) {
          const Rayf ray = maker.ray(population, random);
          if (!in_domain(ray)) continue;
          const Judgement quick = judge.closest(ray), slow = judge.closest_exactly(ray);
          ASSERT_EQ(quick.hit, slow.hit) << family.name << " " << name_of(population);
          if (!quick.hit) continue;
          EXPECT_EQ(quick.t, slow.t) << family.name << " " << name_of(population);
          EXPECT_EQ(quick.face, slow.face) << family.name << " " << name_of(population);
        }
      }
    }
}

TEST(Crosscheck, KnowsTiesByTheirKind) {
  const auto tie = [](const Surface& surface, const Rayf& ray) { return Judge({surface, {}}).closest(ray).tie; };
  EXPECT_EQ(tie(Sphere{5}, {{3, 4, -9}, {0, 0, 1}}), Tie::tangent);
  EXPECT_EQ(tie(Sphere{5}, {{3, 3, -9}, {0, 0, 1}}), Tie::none);
  EXPECT_EQ(tie(Box{{2, 2, 2}}, {{-3, -3, 0}, {1, 1, 0}}), Tie::edge);
  EXPECT_EQ(tie(Box{{2, 2, 2}}, {{-3, 1, 0}, {1, 0, 0}}), Tie::coplanar);
  EXPECT_EQ(tie(Disk{5, 0}, {{3, 1, 4}, {0, -1, 0}}), Tie::edge);
  EXPECT_EQ(tie(Disk{5, 0}, {{-9, 0, 0}, {1, 0, 0}}), Tie::coplanar);
  EXPECT_EQ(tie(Cylinder{4, 2, 2, true}, {{-4, 0, 0}, {1, 1, 0}}), Tie::edge);
  EXPECT_EQ(tie(Cylinder{4, 2, 0, true}, {{-3, 5, 0}, {1, -1, 0}}), Tie::edge);  // through the apex
  EXPECT_EQ(tie(Triangle{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{1, 1, 3}, {0, 0, -1}}), Tie::edge);
}

TEST(Crosscheck, ATangentTakenForAMissIsFound) {
  const Judgement truth = Judge({Sphere{5}, {}}).closest({{3, 4, -9}, {0, 0, 1}});
  ASSERT_TRUE(truth.hit);
  EXPECT_EQ(fault_of(Answer{}, truth, 1), Fault::false_miss);
  EXPECT_EQ(verdict_of(Fault::false_miss, Fault::none, truth), Verdict::b_right);
  EXPECT_EQ(verdict_of(Fault::false_miss, {}, truth), Verdict::both_wrong);
  EXPECT_EQ(verdict_of(Fault::none, Fault::false_miss, truth), Verdict::tie_tangent);
}

TEST(Crosscheck, TheSameSeedGivesTheSameCasesInTheSameOrder) {
  Options options{.rays = 5000, .seed = 11};
  const auto first = cases_of("cone", Population::aimed, options),
             second = cases_of("cone", Population::aimed, options);
  ASSERT_EQ(first.size(), second.size());
  for (size_t k = 0; k < first.size(); ++k) {
    ASSERT_EQ(first[k].index, k);
    ASSERT_EQ(first[k].ray.direction, second[k].ray.direction);
    ASSERT_EQ(first[k].a.t, second[k].a.t);
    ASSERT_EQ(first[k].verdict, second[k].verdict);
  }
}

TEST(Crosscheck, OneRayAloneGetsTheVerdictItGotAmongOthers) {
  Options options{.rays = 4096, .seed = 5};
  for (const Case& c : cases_of("sphere", Population::silhouette, options)) {
    if (c.index % 1000 != 999) continue;
    options.only = c.index;
    const auto alone = cases_of("sphere", Population::silhouette, options);
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(alone[0].ray.direction, c.ray.direction);
    EXPECT_EQ(alone[0].verdict, c.verdict);
    EXPECT_EQ(alone[0].a.t, c.a.t);
  }
}

TEST(Crosscheck, FindsTheErrorsOfEmbreesOwnSphere) {
  Options options{.rays = 4096};
  uint64_t wrong = 0;
  for (const Case& c : cases_of("sphere", Population::silhouette, options)) wrong += c.verdict == Verdict::a_right;
  EXPECT_GT(wrong, 100u);
}

TEST(Crosscheck, FindsTheErrorsOfANaiveSphereAndSaysWhatTheyAre) {
  const Plugin plugin(ALHAZEN_NAIVE_SPHERE);
  Options options{.rays = 4096, .intersector = &plugin.intersector()};
  const Tally tally = check(family_of(plugin.intersector()), Population::silhouette, options, {});
  EXPECT_GT(tally.failures(), 0u);
  EXPECT_GT(tally.a_faults[size_t(Fault::false_miss)], 0u);
  EXPECT_GT(tally.a_faults[size_t(Fault::false_hit)], 0u);
  EXPECT_GT(tally.a_faults[size_t(Fault::wrong_t)], 0u);
  EXPECT_GT(tally.a_worst, 100);
}

TEST(Crosscheck, SaysWhatAPluginLacks) {
  EXPECT_THROW(Plugin("no/such/library.so"), std::exception);
  EXPECT_THROW((void)parse_surface("torus 1 2"), std::invalid_argument);
  EXPECT_THROW((void)parse_surface("sphere"), std::invalid_argument);
  EXPECT_THROW((void)parse_surface("sphere -1"), std::invalid_argument);
  EXPECT_THROW((void)parse_surface("sphere 1 2"), std::invalid_argument);
  EXPECT_TRUE(std::holds_alternative<Box>(parse_surface("box 1 2 3")));
}

}  // namespace
}  // namespace alhazen::crosscheck
