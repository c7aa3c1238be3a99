#include "crosscheck/report.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>

#include "crosscheck/edge_distance.h"
#include "crosscheck/subject_json.h"

namespace alhazen::crosscheck {
namespace {

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string percent(uint64_t part, uint64_t whole) {
  if (whole == 0) return "-";
  if (part == whole) return "100";
  return formatted("%.4f", 100 * double(part) / double(whole));
}

std::string floats(uint64_t judged, double worst) { return judged ? formatted("%.3g", worst) : "-"; }

Json answer_json(const Answer& answer, const Judgement& truth, Fault fault) {
  Json json{{"hit", answer.hit}};
  if (answer.hit) {
    json["t"] = hex(answer.t);
    if (answer.face != kNoFace) json["face"] = answer.face;
    if (truth.hit) json["t_error_ulp"] = floats_between(answer.t, truth.t);
    if (dot(answer.normal_object, answer.normal_object) > 0) json["normal"] = hex(answer.normal_object);
    if (answer.native && answer.native->normal_object != Vec3d{}) json["normal"] = hex(answer.native->normal_object);
    if (answer.native && answer.native->has_uv) json["uv"] = {hex(answer.native->u), hex(answer.native->v)};
  }
  json["fault"] = name_of(fault);
  return json;
}

Json truth_json(const Judgement& truth, bool triangle) {
  constexpr const char* kSides[] = {"inside", "grazing", "outside"};
  constexpr const char* kBy[] = {"double intervals", "double-double intervals", "rationals"};
  Json json{{"hit", truth.hit}};
  if (truth.hit) {
    json["t"] = hex(truth.t), json["face"] = truth.face, json["side"] = kSides[1 - truth.side];
    json["normal"] = hex(truth.normal_object);
    if (triangle) json["uv"] = {hex(truth.u), hex(truth.v)};
  }
  json["tie"] = name_of(truth.tie), json["by"] = kBy[size_t(truth.by)];
  return json;
}

void name_surface(Json& party, const std::string& surface) {
  if (!surface.empty()) party["surface"] = surface;
}

/// How near it was.
Json edge_json(const Subject& subject, const Rayf& ray) {
  const std::optional<EdgeDistance> edge = edge_distance(subject, ray);
  if (!edge) return nullptr;
  return {{"nearest", edge->feature}, {"distance_ulp", edge->ulp}};
}

/// What was asked and what everybody says.
void append_answers(const Case& c, Json& json) {
  json["ray"] = to_json(c.ray);
  json["subject"] = c.subject ? to_json(*c.subject) : Json();
  json["A"] = answer_json(c.a, c.truth, c.a_fault);
  name_surface(json["A"], c.a_surface);
  const bool triangle = c.subject && std::holds_alternative<Triangle>(c.subject->surface);
  if (c.b && c.b_fault) json["B"] = answer_json(*c.b, truth_for_b(c), *c.b_fault), name_surface(json["B"], c.b_surface);
  if (c.b_truth) json["J_of_surface_in_floats"] = truth_json(*c.b_truth, triangle);
  json["J"] = truth_json(c.truth, triangle);
  name_surface(json["J"], c.true_surface);
  json["edge"] = c.subject ? edge_json(*c.subject, c.ray) : Json();
  const EmbreeFacts& embree = embree_facts();
  json["embree"] = {{"version", embree.version},
                    {"isa", embree.isa},
                    {"lanes", embree.lanes},
                    {"scene_flags_A", "robust"},
                    {"scene_flags_B", c.robust_native ? "robust" : "none"}};
}

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string paragraph(const std::string& title, const std::map<std::pair<std::string, Fault>, std::string>& lines) {
  std::string text = title + "\n";
  for (const auto& [key, line] : lines) text += "  " + line + "\n";
  return text;
}

}  // namespace

std::string table_head() {
  return formatted("%-15s %-10s %8s %8s %8s %8s %7s %7s %6s %6s %6s | %9s %9s %9s %9s | %9s %9s %9s\n", "shape",
                   "population", "rays", "hits", "AGREE", "A_RIGHT", "B_RIGHT", "BOTH_WR", "ties", "domain", "unexpl",
                   "A exact %", "A worst", "B exact %", "B worst", "A quad", "A rational", "J rational");
}

std::string table_row(const std::string& family, const std::string& population, const Tally& t) {
  const auto n = [](uint64_t v) { return static_cast<unsigned long long>(v); };
  const uint64_t ties = t.of(Verdict::tie_edge) + t.of(Verdict::tie_tangent) + t.of(Verdict::tie_coplanar);
  return formatted(
      "%-15s %-10s %8llu %8llu %8llu %8llu %7llu %7llu %6llu %6llu %6llu | %9s %9s %9s %9s | %9llu %9llu %9llu\n",
      family.c_str(), population.c_str(), n(t.rays), n(t.hits), n(t.of(Verdict::agree)), n(t.of(Verdict::a_right)),
      n(t.of(Verdict::b_right)), n(t.of(Verdict::both_wrong)), n(ties), n(t.of(Verdict::out_of_domain)),
      n(t.of(Verdict::unexplained)), percent(t.a_exact, t.a_judged).c_str(), floats(t.a_judged, t.a_worst).c_str(),
      percent(t.b_exact, t.b_judged).c_str(), floats(t.b_judged, t.b_worst).c_str(), n(t.a_quads), n(t.a_rationals),
      n(t.judge_rationals));
}

std::string textbook_head() {
  return formatted("%-15s %-10s %8s | %-45s | %-45s\n", "The textbook's", "", "", "plane and half-spaces",
                   "3x3 system") +
         formatted("%-15s %-10s %8s | %7s %7s %7s %10s %9s | %7s %7s %7s %10s %9s\n", "triangles", "population", "rays",
                   "misses", "hits", "wrong t", "exact %", "worst", "misses", "hits", "wrong t", "exact %", "worst");
}

std::string textbook_row(const std::string& family, const std::string& population, const TextbookCounts& counts) {
  const auto n = [](uint64_t v) { return static_cast<unsigned long long>(v); };
  if (counts.front().rays == 0) return "";
  std::string row = formatted("%-15s %-10s %8llu", family.c_str(), population.c_str(), n(counts.front().rays));
  for (const TextbookCount& c : counts) {
    const auto faults = [&](Fault fault) { return n(c.faults[size_t(fault)]); };
    row += formatted(" | %7llu %7llu %7llu %10s %9s", faults(Fault::false_miss), faults(Fault::false_hit),
                     faults(Fault::wrong_t), percent(c.exact, c.judged).c_str(), floats(c.judged, c.worst).c_str());
  }
  return row + "\n";
}

void RelationReport::add(const RelationCounts& counts, const std::function<std::string(uint64_t)>& command) {
  for (size_t k = 0; k < counts.size(); ++k) {
    counts_[k].add(counts[k]);
    if (counts[k].broken == 0 || !examples_[k].empty()) continue;
    examples_[k] = command(*counts[k].first_broken);
  }
}

std::string RelationReport::text() const {
  std::string text;
  for (size_t k = 0; k < counts_.size(); ++k) {
    if (counts_[k].rays == 0) continue;
    text += formatted("  %-18s %10llu rays %8llu broken", name_of(Relation(k)),
                      static_cast<unsigned long long>(counts_[k].rays),
                      static_cast<unsigned long long>(counts_[k].broken)) +
            (examples_[k].empty() ? "" : "  e.g. " + examples_[k]) + "\n";
  }
  return text.empty() ? text : "A, asked in other ways:\n" + text;
}

std::string shell_word(const std::string& text) {
  const auto plain = [](char c) { return std::isalnum(uint8_t(c)) || std::strchr("_-./+,:@%", c); };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string reproduction(const std::string& family, Population population, uint64_t index, uint64_t seed,
                         const std::string& source) {
  return "alhazen crosscheck" + source + " --shape " + shell_word(family) + " --population " + name_of(population) +
         " --seed " + std::to_string(seed) + " --only " + std::to_string(index);
}

std::string record(const std::string& about, const Case& c) {
  Json json{{"about", about}, {"verdict", name_of(c.verdict)}};
  append_answers(c, json);
  return dumped(json);
}

std::string record(const std::string& family, const Case& c, const Options& options, const std::string& source) {
  Json json{{"verdict", name_of(c.verdict)},
            {"shape", family},
            {"population", name_of(c.population)},
            {"seed", options.seed},
            {"index", c.index}};
  append_answers(c, json);
  json["again"] = reproduction(family, c.population, c.index, options.seed, source);
  return dumped(json);
}

std::string picture_text(const PictureTally& picture, const std::string& source) {
  std::string text = formatted(
      "The renderer's own picture of this view, whose triangles are Embree's: %llu of %llu pixels show another surface "
      "than is there; elsewhere t is off by up to %.3g floats.\n",
      static_cast<unsigned long long>(picture.other_surface), static_cast<unsigned long long>(picture.pixels),
      picture.worst_t);
  if (picture.example)
    text +=
        "  e.g. alhazen crosscheck" + source + " --population camera --only " + std::to_string(*picture.example) + "\n";
  return text;
}

void Faults::add(const std::string& family, const Case& c, const std::string& command) {
  const auto note = [&](Table& table, Fault fault, const Answer& answer, const Judgement& truth) {
    if (fault == Fault::none) return;
    Entry& entry = table[{family, fault}];
    if (entry.count++ > 0) return;
    entry.example = command;
    if (fault == Fault::wrong_t)
      entry.example += formatted("  (t %.9g, truly %.9g)", double(answer.t), double(truth.t));
  };
  note(a_, c.a_fault, c.a, c.truth);
  if (c.b_fault) note(b_, *c.b_fault, *c.b, truth_for_b(c));
}

std::string Faults::text() const {
  std::string text;
  for (const auto& [title, table] :
       {std::pair("A, the custom intersector, is wrong:", &a_), std::pair("B, Embree's own, is wrong:", &b_)}) {
    if (table->empty()) continue;
    std::map<std::pair<std::string, Fault>, std::string> lines;
    for (const auto& [key, entry] : *table)
      lines[key] = formatted("%-15s %8llu x %-13s e.g. ", key.first.c_str(),
                             static_cast<unsigned long long>(entry.count), name_of(key.second)) +
                   entry.example;
    text += paragraph(title, lines);
  }
  return text;
}

}  // namespace alhazen::crosscheck
