#include "apps/crosscheck_command.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>

#include "apps/crosscheck_cases.h"
#include "apps/crosscheck_map.h"
#include "apps/crosscheck_target.h"
#include "apps/interruption.h"
#include "apps/limit_options.h"
#include "apps/render_arguments.h"
#include "core/error.h"
#include "crosscheck/extra_report.h"
#include "crosscheck/report.h"
#include "crosscheck/shortest_cases.h"
#include "loaders/image_file.h"
#include "loaders/part_file.h"

namespace alhazen {
namespace {

using namespace crosscheck;

std::atomic<bool> g_stop{false};
constexpr double kLargestCount = 1e15;      // of rays: far more than can be judged, and exact as a double
constexpr uint64_t kLargestRecords = 1000;  // of each family and population

/// Disagreements as lines of a file, which is complete or not there at all.
class RecordFile {
 public:
  explicit RecordFile(const std::string& file) {
    if (!file.empty()) part_ = std::make_unique<PartFile>(file);
  }
  [[nodiscard]] bool is_wanted() const { return part_ != nullptr; }
  void add(std::string line) {
    line += '\n';
    part_->write({reinterpret_cast<const uint8_t*>(line.data()), line.size()});
  }
  void close() {
    if (part_) part_->commit();
    part_.reset();
  }

 private:
  std::unique_ptr<PartFile> part_;
};

bool is_disagreement(const Case& c) { return c.verdict != Verdict::agree || (c.b_fault && *c.b_fault != Fault::none); }

/// All that is said while rays are judged.
struct Session {
  const CrosscheckArguments& arguments;
  const CrosscheckTarget& target;
  RecordFile records;
  Faults faults;
  ShortestCases shortest;
  RelationReport relations;
  std::optional<CrosscheckMap> map;
  Tally total;
  std::string textbook = {};  // rows

  [[nodiscard]] std::string source(Population population) const {
    return target.source + (population == Population::camera ? target.view_options : "");
  }

  void note(const std::string& family, const Case& c, uint64_t& recorded) {
    const Options& options = arguments.options;
    if (map) map->add(family, c);
    if (options.only) std::printf("%s\n", record(family, c, options, source(c.population)).c_str());
    if (!is_disagreement(c)) return;
    const std::string command = reproduction(family, c.population, c.index, options.seed, source(c.population));
    faults.add(family, c, command);
    shortest.add(family, c, command);
    if (records.is_wanted() && (is_failure(c.verdict) || recorded++ < kLargestRecords))
      records.add(record(family, c, options, source(c.population)));
  }

  /// `check(observer)` does the work and returns the tally.
  template <class Check>
  void run(const std::string& family, Population population, const Check& check) {
    if (g_stop) return;
    uint64_t recorded = 0;
    Observer observer;
    observer.stop = [] { return g_stop.load(); };
    observer.judged = [&](const Case& c) { note(family, c, recorded); };
    const Tally tally = check(observer);
    std::printf("%s", table_row(family, name_of(population), tally).c_str());
    std::fflush(stdout);
    total.add(tally);
    textbook += textbook_row(family, name_of(population), tally.textbook);
    relations.add(tally.relations, [&](uint64_t index) {
      return reproduction(family, population, index, arguments.options.seed, source(population));
    });
  }
};

void check_picture(Session& session, PictureTally& picture) {
  const CrosscheckTarget& target = session.target;
  session.run("scene", Population::camera, [&](const Observer& observer) {
    return target.picture->check(target.view, session.arguments.options, observer, picture);
  });
}

/// Of the picture where there is one, else of the families.
CrosscheckMap new_map(const CrosscheckTarget& target) {
  const bool picture = target.picture != nullptr;
  return {picture ? target.view.width : 0, picture ? target.view.height : 0, target.families.size()};
}

/// Whole or not at all.
void write_map(const std::string& file, const CrosscheckMap& map) {
  write_image(file, map.image(), {}, {{"Software", "Alhazen"}});
  if (!map.has_text())
    std::printf("The map has no legend, as there is no font to write it with:\n%s", map.legend().c_str());
}

/// Closed meshes and spawned rays. Returns the number of failures.
uint64_t check_wholes(const CrosscheckTarget& target, const Options& options) {
  const auto stop = [] { return g_stop.load(); };
  uint64_t failures = 0;
  const auto say = [&](const std::string& row, uint64_t wrong) {
    std::printf("%s", row.c_str());
    std::fflush(stdout);
    failures += wrong;
  };
  if (target.meshes) {
    say("\n" + mesh_head(), 0);
    check_meshes(options.rays, options.seed, stop, [&](const MeshTally& t) { say(mesh_row(t), t.failures()); });
  }
  if (target.spawning) {
    say("\n" + spawn_head(), 0);
    check_spawning(options.rays, options.seed, stop, [&](const SpawnTally& t) { say(spawn_row(t), t.self_hits); });
  }
  return failures;
}

int run_crosscheck(CrosscheckArguments& arguments) {
  Options& options = arguments.options;
  options.t_tolerance_a = arguments.t_ulp;
  const int threads = arguments.threads > 0 ? arguments.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
  const CrosscheckTarget target = crosscheck_target(arguments);
  if (target.plugin) options.intersector = &target.plugin->intersector();
  if (!arguments.cases.empty()) return judge_cases(arguments.cases, options) > 0 ? kIntersectorWrong : 0;
  if (!arguments.map.empty()) check_writable(arguments.map, 1, 1);  // before the records' file, one part at a time
  Session session{arguments, target, RecordFile(arguments.json), {}, ShortestCases(options, arguments.shrink), {},
                  {},        {}};
  options.rays = uint64_t(std::ceil(arguments.rays / double(std::max<size_t>(1, target.families.size()))));
  if (!arguments.map.empty()) session.map = new_map(target);
  stop_on_signal(g_stop);

  const bool has_table = !target.families.empty() || target.picture;
  if (has_table) std::printf("%s", table_head().c_str());
  for (const Family& family : target.families)
    for (const Population population : target.populations)
      session.run(family.name, population,
                  [&](const Observer& observer) { return check(family, population, options, observer); });
  PictureTally picture;
  if (target.picture) check_picture(session, picture);
  if (has_table) std::printf("%s", table_row("all", "", session.total).c_str());
  if (!session.textbook.empty()) std::printf("\n%s%s", textbook_head().c_str(), session.textbook.c_str());
  const uint64_t wrong_wholes = check_wholes(target, options);
  std::printf("\n%s", session.relations.text().c_str());
  std::printf("%s", session.faults.text().c_str());
  if (picture.pixels > 0) std::printf("%s", picture_text(picture, session.source(Population::camera)).c_str());
  session.records.close();
  if (!g_stop) std::printf("%s", session.shortest.text().c_str());
  if (session.map) write_map(arguments.map, *session.map);
  if (caught_signal() != 0) return 128 + caught_signal();
  return session.total.failures() + wrong_wholes > 0 ? kIntersectorWrong : int(ExitStatus::done);
}

}  // namespace

Command add_crosscheck_command(CLI::App& program) {
  const auto arguments = std::make_shared<CrosscheckArguments>();
  CLI::App* command =
      program.add_subcommand("crosscheck", "Check intersectors against Embree's own and an exact judge")
          ->group("Commands");
  command->add_option("SCENE", arguments->scene, "glTF 2.0 file (.gltf or .glb): its shapes, triangles and camera rays")
      ->type_name("");
  command
      ->add_option("--shape", arguments->shape,
                   "One kind of shape, or all; of a scene also a node, a mesh, or scene: the camera rays")
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
          "--only", [arguments](uint64_t n) { arguments->options.only = n; }, "Judge this one ray and print its record")
      ->type_name("INDEX");
  command->add_option("--threads", arguments->threads, "Threads; 0: one for each processor")
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""))
      ->capture_default_str();
  command
      ->add_option("--scene", arguments->choice.scene,
                   "Index or name of one of the file's scenes; by default its own choice")
      ->type_name("INDEX|NAME");
  add_size_option(*command, arguments->picture);
  command
      ->add_option("--camera", arguments->camera,
                   "Whose rays: index in the file's cameras, or a name; by default as for render")
      ->type_name("INDEX|NAME");
  command->add_option("--json", arguments->json, "Disagreements, a JSON object a line")->type_name("FILE");
  command->add_option("--map", arguments->map, "A picture of where they disagree, and who is right")
      ->type_name("FILE.png");
  command
      ->add_option("--intersector", arguments->intersector, "A shared library to check instead of the built-in shapes")
      ->type_name("FILE.so");
  command
      ->add_option("--case", arguments->cases,
                   "Judge cases of files instead: what --json and the shortest cases of a run are made of")
      ->type_name("FILE");
  command->add_flag("--shrink", arguments->shrink, "Look for the shortest case of each of Embree's errors, too");
  command->add_option("--t-ulp", arguments->t_ulp, "By how many floats t may be off")
      ->type_name("X")
      ->check(CLI::NonNegativeNumber.description(""))
      ->capture_default_str();
  command->option_defaults()->group("Limits");
  add_limit_options(*command, arguments->limits);
  command->footer(
      "Exit status: 0 no custom intersector is wrong, 5 some are; 2 wrong usage, 3 bad scene or library,\n"
      "4 cannot write, 130 or 143 interrupted, 1 other.\n"
      "\n"
      "Examples:\n"
      "  alhazen crosscheck --shape sphere --population silhouette --rays 1e6\n"
      "  alhazen crosscheck --shape all --rays 1e6\n"
      "  alhazen crosscheck scene.gltf --json disagreements.jsonl --map where.png\n"
      "  alhazen crosscheck --intersector ./naive_sphere.so --json errors.jsonl\n"
      "  alhazen crosscheck --case errors.jsonl");
  return {command, [arguments] { return run_crosscheck(*arguments); }};
}

}  // namespace alhazen
