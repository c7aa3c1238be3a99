#include "apps/bench_report.h"

#include <oneapi/tbb/version.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <thread>

#include "accel/accelerated_scene.h"
#include "apps/render_arguments.h"
#include "apps/sample_statistics.h"
#include "core/error.h"
#include "loaders/image_file.h"

namespace alhazen {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kKindNames{"camera", "camera_shadow", "bounced", "bounced_shadow"};
constexpr std::array kKindTitles{"camera", "their shadow", "bounced", "their shadow"};
constexpr std::array kPhaseNames{"generation", "traversal", "surfaces", "textures", "shading", "film"};
static_assert(kPhaseNames.size() == kPhases && kKindNames.size() == kWaveKinds && kKindTitles.size() == kWaveKinds);
constexpr double kSignificance = 0.01, kLeastChange = 0.01;

template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  char text[400];
  std::snprintf(text, sizeof text, pattern, arguments...);
  return text;
}

const char* integrator_name(Integrator integrator) {
  return integrator == Integrator::signature ? "signature" : "whitted";
}

std::string call_text(const BareCall& call) {
  if (call.width == 1) return "one by one";
  return std::to_string(call.width) + (call.coherence == Coherence::coherent ? " coherent" : " incoherent");
}

/// "balanced, robust, compact"
std::string build_text(const BuildOptions& build) {
  return std::string(build_quality_name(build.quality)) + (build.robust ? ", robust" : ", not robust") +
         (build.compact ? ", compact" : "");
}

double idle_share(const FrameBench& bench) {
  double busy = 0;
  for (const double seconds : bench.phase_s) busy += seconds;
  const double frame = std::accumulate(bench.frame_s.begin(), bench.frame_s.end(), 0.0) / double(bench.frame_s.size());
  return std::max(0.0, 1 - busy / frame);
}

std::string phases_text(const FrameBench& bench) {
  const double idle = idle_share(bench);
  double busy = 0;
  for (const double seconds : bench.phase_s) busy += seconds;
  std::string text;
  for (size_t k = 0; k < kPhases; ++k)
    text += format("%s %.0f %%, ", kPhaseNames[k], 100 * (1 - idle) * bench.phase_s[k] / busy);
  return text + format("idle %.0f %%", 100 * idle);
}

std::string calls_text(const FrameBench& bench) {
  std::string text;
  for (size_t k = 0; k < kWaveKinds; ++k) {
    const BareKind& kind = bench.bare[k];
    if (kind.rays == 0) continue;
    text += format("%s%s rays %.1f Mray/s (%s)", text.empty() ? "" : ", ", kKindTitles[k],
                   1e-6 * double(kind.rays) * bench.threads / kind.seconds, call_text(kind.best).c_str());
  }
  return text;
}

/// The processor's name, as Linux has it.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

Json kinds_json(const FrameBench& bench) {
  Json kinds = Json::object();
  for (size_t k = 0; k < kWaveKinds; ++k) {
    const BareKind& kind = bench.bare[k];
    if (kind.rays == 0) continue;
    kinds[kKindNames[k]] = {{"rays", kind.rays},
                            {"width", kind.best.width},
                            {"coherent", kind.best.coherence == Coherence::coherent},
                            {"seconds_of_all_threads", kind.seconds}};
  }
  return kinds;
}

Json result_json(const FrameBench& bench) {
  Json phases = Json::object();
  for (size_t k = 0; k < kPhases; ++k) phases[kPhaseNames[k]] = bench.phase_s[k];
  return {{"scene", bench.scene},
          {"width", bench.options.width},
          {"height", bench.options.height},
          {"samples", bench.options.samples},
          {"integrator", integrator_name(bench.options.integrator)},
          {"threads", bench.threads},
          {"max_depth", bench.options.max_depth},
          {"min_weight", bench.options.min_weight},
          {"build", build_quality_name(bench.build.quality)},
          {"robust", bench.build.robust},
          {"compact", bench.build.compact},
          {"load_s", bench.load_s},
          {"build_s", bench.build_s},
          {"first_tile_s", bench.first_tile_s},
          {"primitives", bench.primitives},
          {"hierarchy_bytes", bench.hierarchy_bytes},
          {"peak_bytes", bench.peak_bytes},
          {"rays",
           {{"camera", bench.rays.camera},
            {"mirror", bench.rays.mirror},
            {"refracted", bench.rays.refracted},
            {"shadow", bench.rays.shadow}}},
          {"frame_s", bench.frame_s},
          {"traversal_s", bench.traversal_s},
          {"single_ray_traversal_s", bench.single_s},
          {"efficiency", median(bench.efficiencies())},
          {"phase_s", std::move(phases)},
          {"bare", kinds_json(bench)}};
}

/// What makes two results comparable.
Json key_of(const Json& result) {
  Json key;
  for (const char* name : {"scene", "width", "height", "samples", "integrator", "threads"})
    key.push_back(result.at(name));
  key.push_back(result.value("build", "balanced")), key.push_back(result.value("robust", true));
  key.push_back(result.value("compact", false));
  return key;
}

std::string compared(const Json& now, const Json& before, bool& regressed) {
  const auto a = now.at("frame_s").get<std::vector<double>>(), b = before.at("frame_s").get<std::vector<double>>();
  if (a.empty() || b.empty()) return {};
  const double ratio = median(a) / median(b), p = mann_whitney(a, b);
  const bool differs = p < kSignificance && std::abs(ratio - 1) >= kLeastChange;
  regressed |= differs && ratio > 1;
  return format("%-32s %2d threads: %.3f of the time before (%.4f s, %.4f s; p = %.2g)%s\n",
                now.at("scene").get<std::string>().c_str(), now.at("threads").get<int>(), ratio, median(a), median(b),
                p,
                !differs    ? ""
                : ratio > 1 ? "  SLOWER"
                            : "  faster");
}

}  // namespace

std::string bench_text(const FrameBench& bench) {
  const double frame = median(bench.frame_s), traversal = median(bench.traversal_s), single = median(bench.single_s);
  const auto [least, most] = std::ranges::minmax(bench.frame_s);
  return format("%s  %dx%d, %s, %d spp, %d thread%s, %s\n", bench.scene.c_str(), bench.options.width,
                bench.options.height, integrator_name(bench.options.integrator), bench.options.samples, bench.threads,
                bench.threads == 1 ? "" : "s", build_text(bench.build).c_str()) +
         format("  load %.3f s; build %.3f s, %.1f Mprim/s, %.0f bytes each; first tile after %.3f s; peak %.0f MB\n",
                bench.load_s, bench.build_s, 1e-6 * double(bench.primitives) / bench.build_s,
                double(bench.hierarchy_bytes) / double(std::max<uint64_t>(1, bench.primitives)), bench.first_tile_s,
                1e-6 * double(bench.peak_bytes)) +
         format(
             "  frame %.4f s (%.4f to %.4f), %.1f Mray/s: %.2f M camera, %.2f M mirror, %.2f M refracted, %.2f M "
             "shadow\n",
             frame, least, most, 1e-6 * double(bench.rays.all()) / frame, 1e-6 * double(bench.rays.camera),
             1e-6 * double(bench.rays.mirror), 1e-6 * double(bench.rays.refracted), 1e-6 * double(bench.rays.shadow)) +
         format(
             "  Embree alone %.4f s, efficiency %.2f (spread %.2f); with single rays %.4f s, the frame %.2f times "
             "that\n",
             traversal, median(bench.efficiencies()), relative_spread(bench.efficiencies()), single, frame / single) +
         "    " + calls_text(bench) + "\n  time: " + phases_text(bench);
}

std::string breakdown_text(const FrameBench& bench) {
  const double frames = double(bench.frame_s.size()), rays = double(std::max<uint64_t>(1, bench.rays.all()));
  const double frame = std::accumulate(bench.frame_s.begin(), bench.frame_s.end(), 0.0) / frames;
  const auto row = [&](const std::string& name, double seconds) {
    return format("    %-24s %5.1f %% %9.3f ms %8.1f ns a ray\n", name.c_str(), 100 * seconds / frame, 1e3 * seconds,
                  1e9 * seconds * bench.threads / rays);
  };
  std::string text;
  for (size_t k = 0; k < kPhases; ++k) {
    text += row(kPhaseNames[k], bench.phase_s[k]);
    if (Phase(k) == Phase::traversal) text += row("  Embree alone", median(bench.traversal_s));
  }
  text += row("idle", idle_share(bench) * frame) + row("frame", frame);
  text.pop_back();
  return text;
}

Json bench_json(const std::vector<FrameBench>& benches) {
  Json results = Json::array();
  for (const FrameBench& bench : benches) results.push_back(result_json(bench));
  return {{"machine",
           {{"processor", processor()},
            {"processors", std::thread::hardware_concurrency()},
            {"build", ALHAZEN_BUILD},
            {"traversal", traversal_version()},
            {"tasks", std::string("oneTBB ") + TBB_runtime_version()},
            {"program", "Alhazen " ALHAZEN_VERSION}}},
          {"results", std::move(results)}};
}

BenchComparison compare_benches(const Json& now, const std::string& before_file) {
  std::ifstream in(before_file);
  if (!in) throw LoadError(before_file, "", "cannot be read");
  BenchComparison comparison;
  try {
    const Json before = Json::parse(in);
    for (const Json& a : now.at("results"))
      for (const Json& b : before.at("results"))
        if (key_of(a) == key_of(b)) comparison.text += compared(a, b, comparison.regressed);
  } catch (const Json::exception& error) {
    throw LoadError(before_file, "", std::string("is no result of `alhazen bench --json`: ") + error.what());
  }
  if (comparison.text.empty())
    comparison.text = "nothing to compare: no scene, size and number of threads is in both\n";
  return comparison;
}

}  // namespace alhazen
