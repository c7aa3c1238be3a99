#include "crosscheck/shortest_cases.h"

#include "crosscheck/report.h"
#include "crosscheck/subject_check.h"

namespace alhazen::crosscheck {

void ShortestCases::add(const std::string& family, const Case& c, Blamed blamed, Fault fault,
                        const std::string& command) {
  if (fault == Fault::none || !c.subject) return;
  const auto [entry, is_new] = found_.try_emplace(std::tuple(blamed, family, fault));
  if (!is_new) return;
  Found& found = entry->second;
  found.subject = std::make_unique<const Subject>(*c.subject);
  found.c = c, found.command = command;
  found.c.subject = found.subject.get();
}

void ShortestCases::add(const std::string& family, const Case& c, const std::string& command) {
  add(family, c, Blamed::a, c.a_fault, command);
  if (of_native_ && c.a_fault == Fault::none) add(family, c, Blamed::b, c.b_fault.value_or(Fault::none), command);
}

std::string ShortestCases::text() const {
  std::string lines;
  for (const auto& [key, found] : found_) {
    const auto& [blamed, family, fault] = key;
    const auto json = shortest_case(found.c, blamed, options_);
    if (!json) continue;
    const StatedCase shortest = stated_case(*json, "the shortest case");
    const std::string about = std::string(blamed == Blamed::a ? "A" : "B") + " of " + family + ": " + name_of(fault) +
                              ", shrunk from " + found.command;
    lines += record(about, judge_alone(shortest.subject, shortest.ray, shortest.robust_native, options_)) + "\n";
  }
  return lines.empty() ? lines
                       : "The shortest cases found (alhazen crosscheck --case FILE judges such lines again):\n" + lines;
}

}  // namespace alhazen::crosscheck
