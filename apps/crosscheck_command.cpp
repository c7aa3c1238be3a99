#include "apps/crosscheck_command.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>

#include "apps/interruption.h"
#include "apps/suggestion.h"
#include "core/error.h"
#include "crosscheck/crosscheck.h"
#include "crosscheck/plugin.h"
#include "crosscheck/report.h"

namespace alhazen {
namespace {

using namespace crosscheck;

struct Arguments {
  std::string scene, shape = "all", population = "all", json, map, intersector;
  Options options;
  int threads = 0;
  uint64_t only = 0;
  bool has_only = false;
  double t_ulp = 1, rays = 1e5;
};

std::atomic<bool> g_stop{false};
constexpr double kLargestCount = 1e15;      // of rays: far more than can be judged, and exact as a double
constexpr uint64_t kLargestRecords = 1000;  // of each family and population

std::vector<std::string> names_of(const std::vector<Family>& families) {
  std::vector<std::string> names;
  for (const Family& family : families) names.push_back(family.name);
  return names;
}

std::vector<Family> chosen_families(const std::vector<Family>& families, const std::string& name) {
  if (name == "all") return families;
  for (const Family& family : families)
    if (family.name == name) return {family};
  const auto names = names_of(families);
  throw UsageError("--shape: unknown '" + name + "', expected all or one of " + joined(names) +
                   did_you_mean(name, names));
}

std::vector<Population> chosen_populations(const std::string& name, bool camera) {
  std::vector<Population> all;
  std::vector<std::string> names;
  for (int k = 0; k < kPopulations; ++k) {
    if (Population(k) == Population::camera && !camera) continue;
    all.push_back(Population(k)), names.emplace_back(name_of(Population(k)));
    if (name == names.back()) return {all.back()};
  }
  if (name == "all") return all;
  throw UsageError("--population: unknown '" + name + "', expected all or one of " + joined(names) +
                   did_you_mean(name, names));
}

/// Disagreements as lines of a file.
class RecordFile {
 public:
  explicit RecordFile(const std::string& file) : name_(file) {
    if (file.empty()) return;
    out_.open(file);
    if (!out_) throw WriteError(file, "cannot be written");
  }
  [[nodiscard]] bool is_wanted() const { return !name_.empty(); }
  void add(const std::string& line) {
    if (!(out_ << line << '\n')) throw WriteError(name_, "cannot be written");
  }
  void close() {
    if (!name_.empty() && !out_.flush()) throw WriteError(name_, "cannot be written");
  }

 private:
  std::string name_;
  std::ofstream out_;
};

bool is_disagreement(const Case& c) { return c.verdict != Verdict::agree || (c.b_fault && *c.b_fault != Fault::none); }

/// All that is said while rays are judged.
struct Session {
  const Arguments& arguments;
  std::string source;  // as in `reproduction`
  RecordFile records;
  Faults faults;
  RelationReport relations;
  Tally total;

  void check_family(const Family& family, Population population) {
    uint64_t recorded = 0;
    Observer observer;
    observer.stop = [] { return g_stop.load(); };
    observer.judged = [&](const Case& c) {
      const Options& options = arguments.options;
      if (options.only) std::printf("%s\n", record(family.name, c, options, source).c_str());
      if (!is_disagreement(c)) return;
      faults.add(family.name, c, reproduction(family.name, c, options.seed, source));
      if (records.is_wanted() && (is_failure(c.verdict) || recorded++ < kLargestRecords))
        records.add(record(family.name, c, options, source));
    };
    const Tally tally = check(family, population, arguments.options, observer);
    std::printf("%s", table_row(family.name, name_of(population), tally).c_str());
    std::fflush(stdout);
    total.add(tally);
    relations.add(family.name, population, arguments.options.seed, tally.relations);
  }
};

int run_crosscheck(Arguments& arguments) {
  Options& options = arguments.options;
  if (arguments.has_only) options.only = arguments.only;
  options.t_tolerance_a = arguments.t_ulp;
  std::unique_ptr<Plugin> plugin;
  std::vector<Family> families;
  std::string source;
  if (!arguments.intersector.empty()) {
    plugin = std::make_unique<Plugin>(arguments.intersector);
    families = chosen_families({plugin->family()}, arguments.shape);
    options.intersector = &plugin->intersector();
    source = " --intersector " + arguments.intersector;
  } else {
    families = chosen_families(built_in_families(), arguments.shape);
  }
  const std::vector<Population> populations = chosen_populations(arguments.population, false);
  options.rays = uint64_t(std::ceil(arguments.rays / double(families.size())));
  const int threads = arguments.threads > 0 ? arguments.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
  stop_on_signal(g_stop);

  Session session{arguments, source, RecordFile(arguments.json), {}, {}, {}};
  std::printf("%s", table_head().c_str());
  for (const Family& family : families)
    for (const Population population : populations)
      if (!g_stop) session.check_family(family, population);
  std::printf("%s\n%s\n%s", table_row("all", "", session.total).c_str(), session.relations.text().c_str(),
              session.faults.text().c_str());
  session.records.close();
  if (caught_signal() != 0) return 128 + caught_signal();
  return session.total.failures() > 0 ? kIntersectorWrong : int(ExitStatus::done);
}

}  // namespace

Command add_crosscheck_command(CLI::App& program) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      program.add_subcommand("crosscheck", "Check intersectors against Embree's own and an exact judge")
          ->group("Commands");
  command->add_option("--shape", arguments->shape, "One kind of shape, or all")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--population", arguments->population, "One kind of rays, or all")
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--rays", arguments->rays, "Rays of each population, shared among the shapes; 1e6 is a number, too")
      ->type_name("N")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const double n = std::strtod(text.c_str(), nullptr);
            return n >= 1 && n <= kLargestCount ? "" : "expected 1 to 1e15, found " + text;
          },
          ""))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.seed, "The same seed gives the same rays")
      ->type_name("S")
      ->capture_default_str();
  command
      ->add_option_function<uint64_t>(
          "--only", [arguments](uint64_t n) { arguments->only = n, arguments->has_only = true; },
          "Judge this one ray and print its record")
      ->type_name("INDEX");
  command->add_option("--threads", arguments->threads, "Threads; 0: one for each processor")
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""))
      ->capture_default_str();
  command->add_option("--json", arguments->json, "Disagreements, a JSON object a line")->type_name("FILE");
  command
      ->add_option("--intersector", arguments->intersector, "A shared library to check instead of the built-in shapes")
      ->type_name("FILE.so");
  command->add_option("--t-ulp", arguments->t_ulp, "By how many floats t may be off")
      ->type_name("X")
      ->check(CLI::NonNegativeNumber.description(""))
      ->capture_default_str();
  command->footer(
      "Exit status: 0 no custom intersector is wrong, 5 some are; 2 wrong usage, 3 bad scene or library, 4 cannot\n"
      "write, 130 or 143 interrupted, 1 other.\n"
      "\n"
      "Examples:\n"
      "  alhazen crosscheck --shape sphere --population silhouette --rays 1e6\n"
      "  alhazen crosscheck --shape all --rays 1e6\n"
      "  alhazen crosscheck --intersector ./naive_sphere.so --json errors.jsonl");
  return {command, [arguments] { return run_crosscheck(*arguments); }};
}

}  // namespace alhazen
