#include "apps/render_command.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "accel/accelerated_scene.h"
#include "accel/baking.h"
#include "apps/exposure.h"
#include "apps/interruption.h"
#include "apps/peak_memory.h"
#include "apps/pick_camera.h"
#include "apps/picture_metadata.h"
#include "apps/prepare_scene.h"
#include "apps/render_arguments.h"
#include "core/error.h"
#include "inspect/layer_picture.h"
#include "inspect/matte_picture.h"
#include "loaders/gltf_file.h"
#include "loaders/layer_file.h"
#include "renderer/framing.h"

namespace alhazen {
namespace {

constexpr double kClippedShareToMention = 0.1;

RenderControl g_control;  // lives as long as the program, as the signal handler wants

/// Seconds since the last call, or since it was made.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct PhaseSeconds {
  double load = 0, build = 0, render = 0, write = 0;
};

ProgressStyle style_of(const RenderArguments& arguments) {
  return arguments.quiet ? ProgressStyle::none : arguments.progress;
}

std::string title_of(const std::string& scene) { return std::filesystem::path(scene).stem().string(); }

RenderResult render_with_progress(const RenderArguments& arguments, const Scene& scene,
                                  const AcceleratedScene& accelerated, const Camera& camera) {
  const RenderOptions& options = arguments.options;
  const std::string title = title_of(arguments.scene) + " " + std::to_string(options.width) + "x" +
                            std::to_string(options.height) + " " + std::to_string(options.samples) + " spp";
  const ProgressReporter reporter(style_of(arguments), title, uint64_t(options.width) * uint64_t(options.height),
                                  g_control);
  stop_on_signal(g_control.stop);
  return render(scene, accelerated, camera, options, g_control);
}

void mention_clipping(const ColorImage& image, const RenderArguments& arguments) {
  if (arguments.quiet || image_format(arguments.output).linear) return;
  const Clipping clipped = clipping(image);
  if (clipped.share < kClippedShareToMention) return;
  std::fprintf(stderr, "note: %.0f %% of the picture is clipped to white; --exposure %g keeps nearly all of it\n",
               100 * clipped.share, double(arguments.exposure + clipped.stops));
}

/// The layer that is shown instead of the picture; only that of mattes has several images.
ColorImage one_layer_picture(const RenderResult& result) {
  const int width = result.color.width, height = result.color.height;
  return result.layers.size() > 1 ? matte_picture(result.layers, width, height)
                                  : layer_picture(result.layers[0], width, height);
}

void write(const RenderArguments& arguments, RenderResult& result, double render_seconds) {
  const Metadata metadata = picture_metadata(arguments, g_control, result.complete, render_seconds);
  if (arguments.options.integrator == Integrator::signature)
    return write_image(arguments.output, result.ids, arguments.encoding, metadata);
  const bool as_picture = !result.layers.empty() && !image_format(arguments.output).linear;
  if (as_picture) return write_image(arguments.output, one_layer_picture(result), arguments.encoding, metadata);
  expose(result.color, arguments.exposure);
  if (!arguments.ocio.config.empty())
    DisplayTransform(arguments.ocio).apply(result.color);
  else if (arguments.view == ViewTransform::standard)
    mention_clipping(result.color, arguments);
  else
    apply(arguments.view, result.color);
  if (!result.layers.empty())
    return write_layers(arguments.output, result.color, result.layers, arguments.multipart, arguments.encoding,
                        metadata);
  write_image(arguments.output, result.color, arguments.encoding, metadata);
}

/// "5184", "98.3 M"
std::string count_text(uint64_t count) {
  char text[32];
  if (count < 1000000) return std::to_string(count);
  std::snprintf(text, sizeof text, "%.1f M", 1e-6 * double(count));
  return text;
}

std::string facts_text(const std::string& outcome, const PhaseSeconds& seconds, int threads) {
  const RayCounts rays = ray_counts(g_control);
  char times[128], speed[64];
  std::snprintf(times, sizeof times, ": load %.2f s, build %.2f s, render %.2f s, write %.2f s; ", seconds.load,
                seconds.build, seconds.render, seconds.write);
  std::snprintf(speed, sizeof speed, "%.1f Mray/s; peak %.0f MB",
                1e-6 * double(rays.all()) / std::max(seconds.render, 1e-9), 1e-6 * double(peak_memory()));
  return outcome + times + count_text(rays.all()) + " rays (" + count_text(rays.camera) + " camera, " +
         count_text(rays.mirror) + " mirror, " + count_text(rays.refracted) + " refracted, " + count_text(rays.shadow) +
         " shadow; " + count_text(g_control.doubts) + " crossings beyond double), " + speed + "; " +
         std::to_string(threads) + (threads == 1 ? " thread" : " threads");
}

std::string facts_json(const RenderArguments& arguments, std::optional<int> frame, bool complete,
                       const PhaseSeconds& seconds, int threads) {
  const RayCounts rays = ray_counts(g_control);
  nlohmann::ordered_json json;
  json["event"] = complete ? "done" : "interrupted";
  if (frame) json["frame"] = *frame;
  json["output"] = arguments.output;
  json["pixels"] = g_control.pixels_done.load();
  json["seconds"] = {
      {"load", seconds.load}, {"build", seconds.build}, {"render", seconds.render}, {"write", seconds.write}};
  json["doubts"] = g_control.doubts.load();
  json["rays"] = {
      {"camera", rays.camera}, {"mirror", rays.mirror}, {"refracted", rays.refracted}, {"shadow", rays.shadow}};
  json["peak_bytes"] = peak_memory();
  json["threads"] = threads;
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void print_facts(const RenderArguments& arguments, std::optional<int> frame, bool complete, const PhaseSeconds& seconds,
                 int threads) {
  if (arguments.quiet) return;
  const std::string outcome = (frame ? "frame " + std::to_string(*frame) + " " : "") +
                              (complete ? "done"
                                        : "interrupted, " + std::to_string(g_control.tiles_done) + " of " +
                                              std::to_string(g_control.tiles) + " tiles saved as partial");
  const bool json = arguments.progress == ProgressStyle::json;
  std::printf("%s\n",
              (json ? facts_json(arguments, frame, complete, seconds, threads) : facts_text(outcome, seconds, threads))
                  .c_str());
}

int thread_count(const RenderOptions& options) {
  return options.threads > 0 ? options.threads : tbb::info::default_concurrency();
}

/// A view of all that is shown at any time of the animation: the same for parts of a sequence that are rendered apart.
Camera framing_camera_of_all_times(GltfFile& file, Scene& scene, double aspect) {
  constexpr int kTimes = 33;
  const auto [first, last] = file.time_span();
  const auto outline = [&, first = first, last = last](const auto& visit) {
    for (int i = 0; i < kTimes; ++i) {
      file.move(scene, first + (last - first) * i / (kTimes - 1));
      visit_outline(scene.geometry, visit);
    }
  };
  return framing_camera(outline, aspect);
}

/// What is read once, and shown at one time after the other.
struct Stage {
  std::shared_ptr<LoadBudget> budget;
  std::unique_ptr<ProgressReporter> loading;  // until the first frame's scene is built
  GltfFile file;
  LoadedScene loaded;
  std::optional<Camera> framing;  // where no camera is in the file
  std::vector<Opacity> opacity;
  std::unique_ptr<AcceleratedScene> accelerated;  // of the frame before

  /// At the time of the arguments; other times follow in a sequence.
  Stage(const RenderArguments& arguments, bool sequence)
      : budget(std::make_shared<LoadBudget>(arguments.limits)),
        loading(std::make_unique<ProgressReporter>(style_of(arguments), title_of(arguments.scene), budget->progress)),
        file(arguments.scene, print_warning, arguments.choice, arguments.time, budget),
        loaded(load_scene(file, arguments)) {
    if (arguments.shutter > 0 && !file.is_animated() && !arguments.quiet)
      std::fprintf(stderr, "note: --shutter: no animation is played, so nothing moves\n");
    bake_single_instances(loaded.scene.geometry, file.moving_meshes());
    if (!sequence || !loaded.scene.cameras.empty() || !arguments.camera.empty()) return;
    const double aspect = double(arguments.options.width) / arguments.options.height;
    framing = framing_camera_of_all_times(file, loaded.scene, aspect);
    file.move(loaded.scene, *arguments.time.time);
  }

  /// Of what is built for the frame before, all that does not move is kept.
  const AcceleratedScene& accelerate(const RenderArguments& arguments, int threads) {
    const SurfaceFilter filter = surface_filter(loaded.scene, opacity);
    if (accelerated && accelerated->update(filter)) return *accelerated;
    accelerated.reset();
    accelerated = build_scene(loaded, filter, build_options(file, arguments, threads));
    return *accelerated;
  }
};

void reset(RenderControl& control) {
  control.tiles_done = 0, control.tiles = 0;
  for (auto* count : {&control.pixels_done, &control.camera_rays, &control.shadow_rays, &control.mirror_rays,
                      &control.refracted_rays, &control.dropped_samples, &control.doubts})
    *count = 0;
}

/// The scene as it stands on the stage. `watch` runs since its loading began.
int render_still(const RenderArguments& arguments, Stage& stage, std::optional<int> frame, Stopwatch& watch) {
  const RenderOptions& options = arguments.options;
  const int threads = thread_count(options);
  Scene& scene = stage.loaded.scene;
  PhaseSeconds seconds;
  open_shutter(stage.file, scene, arguments);
  const double aspect = double(options.width) / options.height;
  const Camera camera = stage.framing ? *stage.framing : pick_camera(scene, arguments.camera, aspect);
  set_up_lights(scene, camera, arguments);
  seconds.load = watch.lap();

  const AcceleratedScene& accelerated = stage.accelerate(arguments, threads);
  stage.loading.reset();
  seconds.build = watch.lap();

  RenderResult result = render_with_progress(arguments, scene, accelerated, camera);
  seconds.render = watch.lap();
  if (g_control.dropped_samples > 0)
    print_warning(std::to_string(g_control.dropped_samples) + " samples were not finite and left out");
  if (g_control.pixels_done == 0) {
    std::fprintf(stderr, "interrupted before any tile was finished; nothing is written\n");
    return 128 + caught_signal();
  }

  write(arguments, result, seconds.render);
  seconds.write = watch.lap();
  print_facts(arguments, frame, result.complete, seconds, threads);
  return caught_signal() != 0 ? 128 + caught_signal() : int(ExitStatus::done);
}

/// One frame after the other, until one is interrupted.
int render_sequence(const RenderArguments& arguments) {
  const FrameRange& frames = *arguments.frames;
  Stopwatch watch;
  const RenderArguments first = frame_arguments(arguments, frames.first);
  check_writable(first.output, arguments.options.width, arguments.options.height);
  Stage stage(first, true);
  int status = int(ExitStatus::done);
  for (int i = 0; i < frames.count() && status == int(ExitStatus::done); ++i) {
    const RenderArguments still = frame_arguments(arguments, frames.frame(i));
    if (i > 0) stage.file.move(stage.loaded.scene, *still.time.time);
    reset(g_control);
    status = render_still(still, stage, frames.frame(i), watch);
  }
  return status;
}

int run_render(const RenderArguments& given) {
  check_arguments(given);
  const RenderArguments arguments = given.frames ? given : still_arguments(given);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  size_t(thread_count(arguments.options)));
  if (arguments.frames) return render_sequence(arguments);
  check_writable(arguments.output, arguments.options.width, arguments.options.height);
  Stopwatch watch;
  Stage stage(arguments, false);
  return render_still(arguments, stage, std::nullopt, watch);
}

}  // namespace

Command add_render_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Render a scene to a picture")->group("Commands");
  const auto arguments = std::make_shared<RenderArguments>();
  add_render_options(*command, *arguments);
  command->footer(
      "Files hold linear floats (.exr .hdr) or 8 bits, sRGB, clamped (.png .jpg .tif .webp .tga .bmp\n"
      ".ppm and others). Colour is premultiplied by alpha in .exr and .tif, straight elsewhere.\n"
      "Ctrl-C saves what is finished; a second one does not wait for it.\n"
      "Exit status: 0 done, 2 wrong usage, 3 bad scene, 4 cannot write, 130 or 143 interrupted, 1 other.\n"
      "\n"
      "Examples:\n"
      "  alhazen render scene.gltf -o scene.png\n"
      "  alhazen render scene.glb -o beauty.exr --size 1920x1080 --spp 16 --transparent --half\n"
      "  alhazen render scene.glb -o ids.exr --integrator signature\n"
      "  alhazen render scene.glb -o layers.exr --aov albedo,normal,depth,lights,reflected,refracted\n"
      "  alhazen render scene.glb -o cost.png --aov cost\n"
      "  alhazen render shoe.glb -o shoe.png --variant street --camera 1\n"
      "  alhazen render scene.glb -o scene.png --watertight\n"
      "  alhazen render scene.glb -o scene.png --ocio config.ocio --display sRGB --view Filmic\n"
      "  alhazen render fox.glb -o fox.png --animation Run --time 0.5\n"
      "  alhazen render fox.glb -o 'run.####.exr' --animation Run --frames 0:23 --fps 24\n"
      "  alhazen render fox.glb -o fox.png --animation Run --time 0.5 --shutter 0.02 --spp 64");
  return {command, [arguments] { return run_render(*arguments); }};
}

}  // namespace alhazen
