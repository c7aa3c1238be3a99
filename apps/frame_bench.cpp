#include "apps/frame_bench.h"

#include <tbb/combinable.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numeric>

#include "apps/peak_memory.h"
#include "apps/pick_camera.h"
#include "core/fork_join.h"
#include "loaders/gltf.h"
#include "loaders/image_decode.h"

namespace alhazen {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::array<double, kWaveKinds>;
using BareCalls = std::array<BareCall, kWaveKinds>;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void print_warning(const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); }

uint64_t primitives_of(const Geometry& geometry) {
  uint64_t count = geometry.shape_instances.size();
  for (const Mesh& mesh : geometry.meshes)
    for (const TriangleMesh& part : mesh.parts) count += part.triangles.size();
  return count;
}

/// Seconds of all threads, by kind, that these calls take for the waves of a frame: cell by cell in parallel, as the
/// renderer traces them. Kinds whose width is 0 are left out.
Seconds replay(const AcceleratedScene& scene, const WaveLog& log, const BareCalls& calls, tbb::task_arena& arena) {
  tbb::combinable<Seconds> sums([] { return Seconds{}; });
  arena.execute([&] {
    const ForkJoin order;
    tbb::parallel_for(size_t(0), log.cells().size(), order.task([&](size_t cell) {
      Seconds& sum = sums.local();
      for (const LoggedWave& wave : log.cells()[cell]) {
        const auto kind = size_t(wave.kind);
        if (calls[kind].width > 0) sum[kind] += scene.seconds_of(calls[kind], wave.rays);
      }
    }));
  });
  return sums.combine([](Seconds a, const Seconds& b) {
    for (size_t k = 0; k < kWaveKinds; ++k) a[k] += b[k];
    return a;
  });
}

BareCalls all_by(int width, Coherence coherence) {
  BareCalls calls;
  for (size_t k = 0; k < kWaveKinds; ++k) calls[k] = {is_shadow(WaveKind(k)), width, coherence};
  return calls;
}

std::array<BareKind, kWaveKinds> count_rays(const WaveLog& log) {
  std::array<BareKind, kWaveKinds> kinds;
  for (const CellWaves& cell : log.cells())
    for (const LoggedWave& wave : cell) kinds[size_t(wave.kind)].rays += wave.rays.size();
  return kinds;
}

/// Tries every allowed call on every kind of wave, twice, and keeps the fastest.
std::array<BareKind, kWaveKinds> find_best_calls(const AcceleratedScene& scene, const WaveLog& log,
                                                 tbb::task_arena& arena) {
  std::array<BareKind, kWaveKinds> kinds = count_rays(log);
  for (BareKind& kind : kinds) kind.seconds = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 2; ++round)
    for (const int width : {1, 4, 8, 16})
      for (const Coherence coherence : {Coherence::incoherent, Coherence::coherent}) {
        BareCalls calls = all_by(width, coherence);
        for (BareCall& call : calls)
          if (!scene.allows(call)) call.width = 0;
        const Seconds seconds = replay(scene, log, calls, arena);
        for (size_t k = 0; k < kWaveKinds; ++k)
          if (calls[k].width > 0 && seconds[k] < kinds[k].seconds)
            kinds[k].best = calls[k], kinds[k].seconds = seconds[k];
      }
  return kinds;
}

double sum(const Seconds& seconds) { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

/// A scene that is ready to render, and what it took.
struct Subject {
  LoadedScene loaded;
  Camera camera;
  std::vector<Opacity> opacity;
  std::unique_ptr<AcceleratedScene> accelerated;
  RenderResult picture;  // of the frame before
  FrameBench costs;
};

std::unique_ptr<Subject> prepare(const std::string& file, const RenderOptions& options, const BuildOptions& build) {
  auto subject = std::make_unique<Subject>();
  const auto start = Clock::now();
  subject->loaded = load_gltf(file, print_warning);
  Scene& scene = subject->loaded.scene;
  decode_textures(subject->loaded, print_warning);
  bake_single_instances(scene.geometry);
  subject->camera = pick_camera(scene, "", double(options.width) / options.height);
  if (scene.lights.empty() && !scene.has_ambient && !scene.environment) add_studio_lights(scene, subject->camera);
  FrameBench& costs = subject->costs;
  costs.scene = std::filesystem::path(file).filename().string();
  costs.load_s = seconds_since(start);
  const SurfaceFilter filter = surface_filter(scene, subject->opacity);
  const auto build_start = Clock::now();
  subject->accelerated = std::make_unique<AcceleratedScene>(scene.geometry, filter, build);
  costs.build = build;
  costs.build_s = seconds_since(build_start);
  costs.primitives = primitives_of(scene.geometry);
  costs.hierarchy_bytes = subject->accelerated->bytes();

  RenderControl control;
  const auto render_start = Clock::now();
  const auto before = std::chrono::duration<double>(render_start - start).count();
  subject->picture = render(scene, *subject->accelerated, subject->camera, options, control);
  const auto first_tile = Clock::time_point(std::chrono::nanoseconds(control.first_tile_ns));
  costs.first_tile_s = before + std::chrono::duration<double>(first_tile - render_start).count();
  costs.peak_bytes = peak_memory();
  return subject;
}

/// One frame's wall time; its phases and rays go to `result`.
double measure_frame(Subject& subject, FrameBench& result) {
  RenderControl control;
  const auto start = Clock::now();
  subject.picture = render(subject.loaded.scene, *subject.accelerated, subject.camera, result.options, control,
                           std::move(subject.picture));
  const double seconds = seconds_since(start);
  result.rays = ray_counts(control);
  for (size_t k = 0; k < kPhases; ++k) result.phase_s[k] += 1e-9 * double(control.phase_ns[k]) / result.threads;
  return seconds;
}

/// How one more frame, whose clock splits shading and takes time for it, divides it.
void split_shading(Subject& subject, FrameBench& result) {
  constexpr std::array kParts{Phase::surface_points, Phase::textures, Phase::shading};
  RenderControl control;
  control.splits_shading = true;
  subject.picture = render(subject.loaded.scene, *subject.accelerated, subject.camera, result.options, control,
                           std::move(subject.picture));
  double all = 0;
  for (const Phase part : kParts) all += double(control.phase_ns[size_t(part)]);
  const double shading = result.phase_s[size_t(Phase::shading)];
  if (all > 0)
    for (const Phase part : kParts)
      result.phase_s[size_t(part)] = shading * double(control.phase_ns[size_t(part)]) / all;
}

FrameBench measure(Subject& subject, const RenderOptions& options, int threads, int repeats) {
  FrameBench result = subject.costs;
  result.options = options, result.options.threads = result.threads = threads;
  tbb::task_arena arena(threads);
  WaveLog log;
  RenderControl control;
  control.log = &log;
  subject.picture = render(subject.loaded.scene, *subject.accelerated, subject.camera, result.options, control,
                           std::move(subject.picture));
  result.bare = find_best_calls(*subject.accelerated, log, arena);
  BareCalls best;
  for (size_t k = 0; k < kWaveKinds; ++k) best[k] = result.bare[k].best;
  const BareCalls single = all_by(1, Coherence::incoherent);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    result.frame_s.push_back(measure_frame(subject, result));
    result.traversal_s.push_back(sum(replay(*subject.accelerated, log, best, arena)) / threads);
    result.single_s.push_back(sum(replay(*subject.accelerated, log, single, arena)) / threads);
  }
  for (double& seconds : result.phase_s) seconds /= repeats;
  split_shading(subject, result);
  return result;
}

}  // namespace

std::vector<double> FrameBench::efficiencies() const {
  std::vector<double> all;
  for (size_t i = 0; i < frame_s.size(); ++i) all.push_back(traversal_s[i] / frame_s[i]);
  return all;
}

std::vector<FrameBench> bench_frames(const std::string& file, const RenderOptions& options, const BuildOptions& build,
                                     const std::vector<int>& threads, int repeats) {
  const std::unique_ptr<Subject> subject = prepare(file, options, build);
  std::vector<FrameBench> results;
  for (const int count : threads) results.push_back(measure(*subject, options, count, repeats));
  return results;
}

}  // namespace alhazen
