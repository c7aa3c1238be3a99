#include "apps/crosscheck_cases.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "core/error.h"
#include "crosscheck/plugin.h"
#include "crosscheck/report.h"
#include "crosscheck/stated_case.h"
#include "crosscheck/subject_check.h"

namespace alhazen {
namespace {

using namespace crosscheck;

constexpr size_t kLargestFile = size_t{1} << 28;  // bytes

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw LoadError(file, "", "cannot be opened");
  std::string text, chunk(size_t{1} << 16, '\0');
  while (in.read(chunk.data(), std::streamsize(chunk.size())), in.gcount() > 0) {
    text.append(chunk, 0, size_t(in.gcount()));
    if (text.size() > kLargestFile) throw LoadError(file, "", "is larger than 256 MiB");
  }
  if (text.empty()) throw LoadError(file, "", "cannot be read, or is empty");
  return text;
}

struct Entry {
  std::string place;  // file and line
  Json json;
};

void append_lines(const std::string& file, const std::string& text, std::vector<Entry>& entries) {
  size_t number = 0;
  for (size_t at = 0; at < text.size(); ++number) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at), place = file + ":" + std::to_string(number + 1);
    at = end + 1;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    entries.push_back({place, Json::parse(line, nullptr, false)});
    if (entries.back().json.is_discarded()) throw LoadError(place, "", "is not JSON: expected a case a line");
  }
}

void append_entries(const std::string& file, std::vector<Entry>& entries) {
  const std::string text = content_of(file);
  Json whole = Json::parse(text, nullptr, false);
  if (whole.is_discarded()) return append_lines(file, text, entries);
  if (!whole.is_array()) return entries.push_back({file, std::move(whole)});
  for (size_t k = 0; k < whole.size(); ++k) entries.push_back({file + "[" + std::to_string(k) + "]", whole[k]});
}

void refuse_other_surface(const StatedCase& stated, const std::string& place, const Options& options) {
  if (!options.intersector) return;
  const std::string claimed = options.intersector->surface();
  if (to_json(Subject{stated.subject.surface, stated.subject.world_from_object}) !=
      to_json(Subject{parse_surface(claimed), {}}))
    throw LoadError(place, "/subject", "expected the library's own, " + claimed);
}

/// Whether it passes.
bool judge_case(const Entry& entry, bool alone, const Options& options) {
  const StatedCase stated = stated_case(entry.json, entry.place);
  refuse_other_surface(stated, entry.place, options);
  const Case c = judge_alone(stated.subject, stated.ray, stated.robust_native, options);
  const bool as_stated = is_as_stated(c.truth, stated), passes = as_stated && !is_failure(c.verdict);
  const std::string b = c.b_fault ? std::string(", B ") + name_of(*c.b_fault) : "";
  std::printf("%s  %s: A %s%s%s%s%s\n", entry.place.c_str(), name_of(c.verdict), name_of(c.a_fault), b.c_str(),
              as_stated ? "" : ", J SAYS SOMETHING ELSE THAN IS STATED", stated.about.empty() ? "" : "  ",
              stated.about.c_str());
  if (alone || !passes) std::printf("%s\n", record(stated.about, c).c_str());
  return passes;
}

}  // namespace

uint64_t judge_cases(const std::vector<std::string>& files, const Options& options) {
  std::vector<Entry> entries;
  for (const std::string& file : files) append_entries(file, entries);
  uint64_t wrong = 0;
  for (const Entry& entry : entries) wrong += !judge_case(entry, entries.size() == 1, options);
  return wrong;
}

}  // namespace alhazen
