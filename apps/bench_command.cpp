#include "apps/bench_command.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench_ladder.h"
#include "apps/bench_plot.h"
#include "apps/bench_report.h"
#include "apps/render_arguments.h"
#include "apps/sample_statistics.h"
#include "apps/scratch_folder.h"
#include "apps/usage.h"
#include "core/error.h"
#include "loaders/part_file.h"
#include "procedural/databases.h"
#include "procedural/nff_to_gltf.h"

namespace alhazen {
namespace {

struct BenchArguments {
  std::vector<std::string> scenes;
  std::string ladder, json, plot, before;
  std::vector<int> threads;
  RenderOptions options{.width = 1024, .height = 1024}, ladder_options{.width = 160, .height = 120};
  BuildOptions build;
  bool has_size = false, plain_triangles = false, breakdown = false;
  int repeats = 9;
};

void write_text(const std::string& file, const std::string& text) {
  PartFile part(file);
  part.write({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  part.commit();
}

std::string dumped(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Frame time over that of the first number of threads.
void print_scaling(const std::vector<FrameBench>& benches) {
  if (benches.size() < 2) return;
  const auto middle = [](const FrameBench& bench) { return median(bench.frame_s); };
  std::printf("  scaling:");
  for (const FrameBench& bench : benches)
    std::printf(" %d threads %.2f x%s", bench.threads, middle(benches[0]) / middle(bench),
                &bench == &benches.back() ? "\n" : ",");
}

/// The well-known scenes, at their usual sizes.
std::vector<std::string> make_suite(const ScratchFolder& folder) {
  std::vector<std::string> files;
  for (const Database& database : databases()) {
    files.push_back((folder.path() / (database.name + ".glb")).string());
    const std::vector<uint8_t> glb = glb_of(database.make(database.default_size), {});
    PartFile part(files.back());
    part.write(glb);
    part.commit();
  }
  return files;
}

int run_bench(const BenchArguments& arguments) {
  std::optional<ScratchFolder> folder;
  std::vector<std::string> scenes = arguments.scenes;
  if (scenes.empty()) scenes = make_suite(folder.emplace());
  std::vector<int> threads = arguments.threads;
  if (threads.empty()) threads.push_back(tbb::info::default_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  size_t(*std::ranges::max_element(threads)));
  for (const std::string& file : {arguments.json, arguments.plot})
    if (!file.empty()) (void)PartFile(file);  // before the work is done
  std::vector<FrameBench> all;
  for (const std::string& scene : scenes) {
    const std::vector<FrameBench> benches =
        bench_frames(scene, arguments.options, arguments.build, threads, arguments.repeats);
    for (const FrameBench& bench : benches) {
      std::printf("%s\n", bench_text(bench).c_str());
      if (arguments.breakdown) std::printf("%s\n", breakdown_text(bench).c_str());
    }
    print_scaling(benches);
    std::fflush(stdout);
    all.insert(all.end(), benches.begin(), benches.end());
  }
  const nlohmann::ordered_json json = bench_json(all);
  if (!arguments.json.empty()) write_text(arguments.json, dumped(json));
  if (!arguments.plot.empty()) write_text(arguments.plot, bench_svg(all));
  if (arguments.before.empty()) return int(ExitStatus::done);
  const BenchComparison comparison = compare_benches(json, arguments.before);
  std::printf("%s", comparison.text.c_str());
  return int(comparison.regressed ? ExitStatus::regressed : ExitStatus::done);
}

int run(const BenchArguments& arguments) {
  if (arguments.ladder.empty()) return run_bench(arguments);
  const RenderOptions& size = arguments.has_size ? arguments.options : arguments.ladder_options;
  print_ladder(arguments.ladder, size.width, size.height);
  return int(ExitStatus::done);
}

}  // namespace

Command add_bench_command(CLI::App& program) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = program.add_subcommand("bench", "Measure what tracing a scene costs")->group("Commands");
  command
      ->add_option("SCENE", arguments->scenes,
                   "glTF 2.0 files (.gltf or .glb); by default the scenes of `alhazen make`")
      ->type_name("...");
  add_size_option(*command, arguments->options);
  add_choice<Integrator>(*command, "--integrator", arguments->options.integrator,
                         {{"whitted", Integrator::whitted}, {"signature", Integrator::signature}},
                         "What a frame is: light, or which node, primitive and material are seen");
  command->add_option("--spp", arguments->options.samples, "Samples per pixel")
      ->type_name("N")
      ->check(CLI::Range(1, 65536).description(""))
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "One or more numbers of threads; by default all processors")
      ->type_name("N,N...")
      ->delimiter(',')
      ->check(CLI::Range(1, 4096).description(""))
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--repeat", arguments->repeats, "Frames that are measured")
      ->type_name("N")
      ->check(CLI::Range(1, 10000).description(""))
      ->capture_default_str();
  add_build_options(*command, arguments->build.quality, arguments->build.compact);
  command->add_flag("--no-robust", arguments->plain_triangles,
                    "Embree's default triangle test: faster, and a ray may slip between two triangles");
  command->add_flag("--breakdown", arguments->breakdown, "A table of where the frame's time goes, for each ray too");
  command->add_option("--json", arguments->json, "All samples and what they were taken on")->type_name("FILE");
  command->add_option("--plot", arguments->plot, "The same as a drawing (.svg): rays a second by kind, and scaling")
      ->type_name("FILE");
  command
      ->add_option("--compare", arguments->before,
                   "Says which frames are slower or faster than those of an earlier --json")
      ->type_name("FILE");
  command->add_option("--ladder", arguments->ladder, "Camera rays of this scene by every accelerator, simplest first")
      ->type_name("SCENE");
  command->footer(
      "Efficiency is the time that Embree's fastest calls take for the rays of a frame, on the same\n"
      "threads and without the renderer, over the frame's. Frames and these are measured in turn.\n"
      "Exit status: 0 done, 6 some frame is slower than before; 2 wrong usage, 3 bad scene or file,\n"
      "4 cannot write, 1 other.\n"
      "\n"
      "Examples:\n"
      "  alhazen bench scene.glb --threads 1,2,4 --json now.json\n"
      "  alhazen bench scene.glb --compare before.json --plot now.svg\n"
      "  alhazen bench scene.glb --build fast --breakdown\n"
      "  alhazen bench --ladder scene.gltf --size 320x240");
  return {command, [arguments, command] {
            arguments->build.robust = !arguments->plain_triangles;
            arguments->has_size = command->count("--size") > 0;
            return run(*arguments);
          }};
}

}  // namespace alhazen
