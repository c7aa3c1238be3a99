#include "crosscheck/check_intersector.h"

#include "crosscheck/plugin.h"
#include "crosscheck/report.h"
#include "crosscheck/shortest_cases.h"

namespace alhazen::crosscheck {
namespace {

/// Where a ray comes from, as there is no command that shows it.
std::string place_of(const Case& c, uint64_t seed) {
  return std::string("ray ") + std::to_string(c.index) + " of " + name_of(c.population) + ", seed " +
         std::to_string(seed);
}

}  // namespace

IntersectorReport check_intersector(const Intersector& intersector, const IntersectorCheck& check) {
  const Family family = family_of(intersector);
  const Options options{
      .rays = check.rays, .seed = check.seed, .t_tolerance_a = check.t_ulp, .intersector = &intersector};
  IntersectorReport report;
  report.text = table_head();
  Faults faults;
  ShortestCases shortest(options, false);
  Observer observer;
  observer.judged = [&](const Case& c) {
    faults.add(family.name, c, place_of(c, check.seed));
    shortest.add(family.name, c, place_of(c, check.seed));
  };
  for (int p = 0; p < int(Population::camera); ++p) {
    const Tally tally = crosscheck::check(family, Population(p), options, observer);
    report.text += table_row(family.name, name_of(Population(p)), tally);
    report.rays += tally.rays, report.hits += tally.hits, report.wrong += tally.failures();
  }
  report.text += "\n" + faults.text() + shortest.text();
  return report;
}

}  // namespace alhazen::crosscheck
