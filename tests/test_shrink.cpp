#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "crosscheck/plugin.h"
#include "crosscheck/report.h"
#include "crosscheck/shortest_case.h"
#include "crosscheck/shrink.h"
#include "crosscheck/simpler_number.h"
#include "crosscheck/subject_check.h"

namespace alhazen::crosscheck {
namespace {

constexpr int kEnough = 1000000;
std::vector<Json> no_rewrites(const Json&) { return {}; }

double number_at(const Json& json, const char* name) {
  return std::strtod(json[name].get<std::string>().c_str(), nullptr);
}

/// Random numbers under the names of a predicate that holds for them: a circle's inside, a sum, an order.
struct Puzzle {
  Json start;
  Holds holds;
};
Puzzle random_puzzle(Random& random) {
  const double x = random.uniform(1, 9), y = random.uniform(-9, -1);
  const Json start{{"x", hex(x)}, {"y", hex(y)}, {"list", {{{"a", hex(x * y)}}, {{"a", hex(x)}}, {{"a", hex(y)}}}}};
  const double least = random.uniform(0.1, 0.9) * x, most = 0.5 * y;
  return {start, [=](const Json& json) {
            if (!json.contains("x") || !json.contains("y") || json["list"].empty()) return false;
            return number_at(json, "x") >= least && number_at(json, "y") <= most;
          }};
}

TEST(Shrink, SimplerNumbersAreSimplerAndFloatsStayFloats) {
  Random random{1};
  for (int k = 0; k < 2000; ++k) {
    const float x = float(random.uniform() * random.decades(-30, 18));
    for (const double simpler : simpler_numbers(double(x), true)) {
      EXPECT_LT(complexity(simpler), complexity(double(x)));
      EXPECT_EQ(double(float(simpler)), simpler);
    }
  }
  EXPECT_TRUE(simpler_numbers(0, true).empty());
  EXPECT_LT(complexity(3.0), complexity(0.1));
}

TEST(Shrink, TheResultStillHoldsIsNoLongerAndALocalMinimum) {
  Random random{2};
  for (int k = 0; k < 200; ++k) {
    const Puzzle puzzle = random_puzzle(random);
    ASSERT_TRUE(puzzle.holds(puzzle.start));
    const Json result = shrunk(puzzle.start, puzzle.holds, no_rewrites, kEnough);
    EXPECT_TRUE(puzzle.holds(result));
    EXPECT_LE(complexity(result), complexity(puzzle.start));
    EXPECT_FALSE(for_each_simpler(result, no_rewrites, puzzle.holds)) << result.dump();
    EXPECT_EQ(result["list"].size(), 1u);
    EXPECT_EQ(result, shrunk(puzzle.start, puzzle.holds, no_rewrites, kEnough));
    EXPECT_EQ(result, shrunk(result, puzzle.holds, no_rewrites, kEnough));
  }
}

TEST(Shrink, EndsWhenItsTriesAreSpent) {
  Random random{3};
  const Puzzle puzzle = random_puzzle(random);
  int asked = 0;
  const Holds counted = [&](const Json& json) { return ++asked, puzzle.holds(json); };
  EXPECT_TRUE(puzzle.holds(shrunk(puzzle.start, counted, no_rewrites, 7)));
  EXPECT_LE(asked, 7);
}

/// The first case of a family in which a party has a fault of that kind.
struct FoundCase {
  Subject subject;
  Case c;
};
std::optional<FoundCase> first_case(const Family& family, Population population, Blamed blamed, Fault fault,
                                    const Options& options) {
  std::optional<FoundCase> found;
  Observer observer;
  observer.judged = [&](const Case& c) {
    const Fault said = blamed == Blamed::a ? c.a_fault : c.b_fault.value_or(Fault::none);
    if (!found && said == fault && c.a_fault == (blamed == Blamed::a ? fault : Fault::none)) found = {*c.subject, c};
  };
  (void)check(family, population, options, observer);
  return found;
}

TEST(Shrink, ANaiveSpheresShortestCasesFailAsTheFirstOnesDid) {
  const Plugin plugin(ALHAZEN_NAIVE_SPHERE);
  const Options options{.rays = 4096, .intersector = &plugin.intersector()};
  for (const Fault fault : {Fault::false_miss, Fault::false_hit, Fault::wrong_t}) {
    auto found = first_case(family_of(plugin.intersector()), Population::silhouette, Blamed::a, fault, options);
    ASSERT_TRUE(found);
    found->c.subject = &found->subject;
    const auto json = shortest_case(found->c, Blamed::a, options);
    ASSERT_TRUE(json);
    const StatedCase shortest = stated_case(*json, "shortest");
    EXPECT_EQ(judge_alone(shortest.subject, shortest.ray, false, options).a_fault, fault);
    EXPECT_EQ(to_json(shortest.subject), to_json(found->subject));
    EXPECT_LT(complexity(to_json(shortest.ray)), complexity(to_json(found->c.ray))) << json->dump();
    EXPECT_EQ(*json, *shortest_case(found->c, Blamed::a, options));
  }
}

TEST(Shrink, EmbreesOwnFaultsShrinkWithTheirSubjects) {
  const Options options{.rays = 4096};
  for (const Family& family : built_in_families()) {
    auto found = first_case(family, Population::aimed, Blamed::b, Fault::false_miss, options);
    if (!found) continue;
    found->c.subject = &found->subject;
    const auto json = shortest_case(found->c, Blamed::b, options);
    if (!json) continue;  // a ray alone is traced another way than among others
    const StatedCase shortest = stated_case(*json, "shortest");
    const Case c = judge_alone(shortest.subject, shortest.ray, shortest.robust_native, options);
    EXPECT_EQ(c.a_fault, Fault::none);
    EXPECT_EQ(c.b_fault, Fault::false_miss);
  }
}

TEST(StatedCase, IsWhatWasWrittenOfEveryFamilyAndKindOfRay) {
  for (const Family& family : built_in_families())
    for (int p = 0; p < int(Population::camera); ++p) {
      Random random{4, uint64_t(p)};
      const bool lattice = Population(p) == Population::lattice;
      const Subject subject = family.subject(0, lattice, random);
      const Judge judge(subject);
      const Rayf ray = RayMaker(subject, judge).ray(Population(p), random);
      if (!in_domain(ray)) continue;
      const Case c = judge_alone(subject, ray, family.robust_native, {});
      const StatedCase stated = stated_case(Json::parse(record("a test", c)), "record");
      EXPECT_EQ(to_json(stated.subject), to_json(subject)) << family.name;
      EXPECT_EQ(to_json(stated.ray), to_json(ray)) << family.name;
      EXPECT_EQ(stated.robust_native, family.robust_native);
      EXPECT_TRUE(is_as_stated(c.truth, stated)) << family.name;
      EXPECT_EQ(judge_alone(stated.subject, stated.ray, stated.robust_native, {}).a.t, c.a.t) << family.name;
    }
}

TEST(StatedCase, SaysWhereItIsWrong) {
  const std::string good =
      R"({"subject":{"sphere":{"radius":1},"world_from_object_columns":[[1,0,0],[0,1,0],[0,0,1],[0,0,0]]},)"
      R"("ray":{"origin":[0,0,"0x1p+1"],"direction":[0,0,-1],"t_min":0,"t_max":"inf"}})";
  EXPECT_TRUE(judge_alone(stated_case(Json::parse(good), "f").subject, {{0, 0, 2}, {0, 0, -1}}, false, {}).a.hit);
  const auto pointer_of = [&](const std::string& from, const std::string& to) -> std::string {
    std::string bad = good;
    bad.replace(bad.find(from), from.size(), to);
    try {
      (void)stated_case(Json::parse(bad), "f");
    } catch (const LoadError& error) {
      const std::string what = error.what();
      return what.substr(3, what.find(": expected") - 3);
    }
    return "none";
  };
  EXPECT_EQ(pointer_of("\"radius\":1", "\"radius\":-1"), "/subject/sphere");
  EXPECT_EQ(pointer_of("\"radius\":1", "\"radius\":\"x\""), "/subject/sphere/radius");
  EXPECT_EQ(pointer_of("\"radius\":1", "\"radius\":1e300"), "/subject/sphere/radius");
  EXPECT_EQ(pointer_of("[1,0,0]", "[0,0,0]"), "/subject/world_from_object_columns");
  EXPECT_EQ(pointer_of("\"0x1p+1\"", "0.1"), "/ray/origin/2");
  EXPECT_EQ(pointer_of("\"t_min\":0,", ""), "/ray");
  EXPECT_EQ(pointer_of("\"sphere\"", "\"torus\""), "/subject");
}

}  // namespace
}  // namespace alhazen::crosscheck
