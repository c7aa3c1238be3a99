// The command line: scene file in, picture out.
#include <OpenImageIO/imageio.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_invoke.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "accel/accelerated_scene.h"
#include "core/error.h"
#include "loaders/gltf.h"
#include "loaders/image_file.h"
#include "renderer/render.h"

namespace alhazen {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// ---- Interruption ----

RenderControl g_control;
std::atomic<int> g_signal{0};
std::atomic<bool> g_something_to_save{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

/// The first signal stops the render, whose finished part is saved; a second one, or one with nothing to save, ends at
/// once.
extern "C" void on_signal(int signal) {
  if (g_signal.exchange(signal) != 0 || !g_something_to_save) _exit(128 + signal);
  g_control.stop = true;
}

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

// ---- Arguments ----

struct RenderArguments {
  std::string scene, output, size = "1280x720", camera, integrator = "whitted", lights = "auto", background, ambient;
  RenderOptions options;
  float exposure = 0;
  bool quiet = false;
};

void parse_size(const std::string& text, RenderOptions& options) {
  int width = 0, height = 0, used = 0;
  if (std::sscanf(text.c_str(), "%6dx%6d%n", &width, &height, &used) != 2 || size_t(used) != text.size() || width < 1 ||
      height < 1 || width > 65536 || height > 65536)
    throw UsageError("--size: '" + text + "' is not WIDTHxHEIGHT with both in 1 to 65536");
  options.width = width, options.height = height;
}

Rgb parse_color(const char* option, const std::string& text) {
  Rgb color;
  int used = 0;
  const int found = std::sscanf(text.c_str(), "%f,%f,%f%n", &color.r, &color.g, &color.b, &used);
  const auto valid = [](float v) { return std::isfinite(v) && v >= 0; };
  if (found != 3 || size_t(used) != text.size() || !valid(color.r) || !valid(color.g) || !valid(color.b))
    throw UsageError(std::string(option) + ": '" + text + "' is not three numbers r,g,b, finite and not negative");
  return color;
}

Camera pick_camera(const Scene& scene, const std::string& wanted, double aspect) {
  if (wanted.empty())
    return scene.cameras.empty() ? framing_camera(world_bounds(scene.geometry), aspect) : scene.cameras[0];
  for (size_t i = 0; i < scene.cameras.size(); ++i)
    if (std::to_string(scene.camera_index[i]) == wanted) return scene.cameras[i];
  for (const Camera& camera : scene.cameras)
    if (camera.name == wanted) return camera;
  std::string known;
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    known += (i == 0 ? "" : ", ") + std::to_string(scene.camera_index[i]);
    if (!scene.cameras[i].name.empty()) known += " '" + scene.cameras[i].name + "'";
  }
  throw UsageError("--camera: there is no camera '" + wanted + "'; " +
                   (known.empty() ? "the scene has none" : "the scene has " + known));
}

void set_up_lights(Scene& scene, const Camera& camera, const RenderArguments& arguments) {
  if (!arguments.ambient.empty()) scene.ambient = parse_color("--ambient", arguments.ambient), scene.has_ambient = true;
  if (!arguments.background.empty())
    scene.background = parse_color("--background", arguments.background), scene.has_background = true;
  const bool unlit = scene.lights.empty() && !scene.has_ambient;
  if (arguments.lights == "studio") scene.lights.clear();
  if (arguments.lights == "studio" || (arguments.lights == "auto" && unlit)) add_studio_lights(scene, camera);
}

// ---- Output ----

void print_warning(const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); }

void expose(ColorImage& image, float stops) {
  if (stops == 0) return;
  const float factor = std::exp2(stops);
  for (size_t i = 0; i < image.pixels.size(); ++i)
    if (image.channels[i % image.channels.size()] != "A") image.pixels[i] *= factor;
}

uint64_t rays(const RenderControl& control) {
  return control.camera_rays + control.shadow_rays + control.mirror_rays + control.refracted_rays;
}

/// One line on a terminal, renewed five times a second until `stop`, then wiped.
void show_progress(const std::stop_token& stop, const RenderControl& control) {
  const auto start = Clock::now();
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  bool shown = false;
  while (!wake.wait_for(lock, stop, std::chrono::milliseconds(200), [&] { return stop.stop_requested(); })) {
    if (stop.stop_requested()) break;
    const uint32_t done = control.tiles_done, all = control.tiles;
    const double seconds = seconds_since(start);
    std::fprintf(stderr, "\rrender %3.0f %%  %.1f s  %.1f M rays/s\033[K", all ? 100.0 * done / all : 0.0, seconds,
                 1e-6 * double(rays(control)) / seconds);
    shown = true;
  }
  if (shown) std::fprintf(stderr, "\r\033[K");
}

// ---- Commands ----

int run_render(RenderArguments& arguments) {
  RenderOptions& options = arguments.options;
  parse_size(arguments.size, options);
  options.integrator = arguments.integrator == "signature" ? Integrator::signature : Integrator::whitted;
  if (!arguments.ambient.empty()) (void)parse_color("--ambient", arguments.ambient);
  if (!arguments.background.empty()) (void)parse_color("--background", arguments.background);
  if (!std::isfinite(arguments.exposure)) throw UsageError("--exposure: not a finite number");
  if (!std::isfinite(options.min_weight)) throw UsageError("--min-weight: not a finite number");
  check_writable(arguments.output);

  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));

  auto start = Clock::now();
  LoadedScene loaded = load_gltf(arguments.scene, print_warning);
  Scene& scene = loaded.scene;
  bake_single_instances(scene.geometry);
  const Camera camera = pick_camera(scene, arguments.camera, double(options.width) / options.height);
  set_up_lights(scene, camera, arguments);
  const double load_seconds = seconds_since(start);

  start = Clock::now();
  std::vector<Opacity> opacity;
  const SurfaceFilter filter = surface_filter(scene, opacity);
  std::unique_ptr<AcceleratedScene> accelerated;
  std::vector<TextureImage> images;
  tbb::parallel_invoke(
      [&] {
        accelerated = std::make_unique<AcceleratedScene>(scene.geometry, filter, BuildOptions{.threads = threads});
      },
      [&] { images = decode_images(loaded.encoded, print_warning); });
  scene.images = std::move(images);
  loaded.encoded = {};
  const double build_seconds = seconds_since(start);

  start = Clock::now();
  RenderResult result;
  {
    g_something_to_save = true;
    std::jthread progress;
    if (!arguments.quiet && isatty(STDERR_FILENO))
      progress = std::jthread([](const std::stop_token& stop) { show_progress(stop, g_control); });
    result = render(scene, *accelerated, camera, options, g_control);
  }
  const double render_seconds = seconds_since(start);
  if (g_control.dropped_samples > 0)
    print_warning(std::to_string(g_control.dropped_samples) + " samples were not finite and left out");

  start = Clock::now();
  Metadata metadata = {{"Software", "Alhazen " ALHAZEN_VERSION},
                       {"alhazen:integrator", arguments.integrator},
                       {"alhazen:traversal", traversal_version()}};
  if (!result.complete) metadata.emplace_back("alhazen:partial", "1");
  if (options.integrator == Integrator::signature) {
    write_image(arguments.output, result.ids, metadata);
  } else {
    expose(result.color, arguments.exposure);
    write_image(arguments.output, result.color, metadata);
  }

  if (!arguments.quiet) {
    std::printf(
        "%s: load %.2f s, build %.2f s, render %.2f s, write %.2f s; %llu rays (%llu camera, %llu shadow, %llu mirror, "
        "%llu refracted); %d threads\n",
        result.complete ? "done" : "interrupted", load_seconds, build_seconds, render_seconds, seconds_since(start),
        static_cast<unsigned long long>(rays(g_control)), static_cast<unsigned long long>(g_control.camera_rays),
        static_cast<unsigned long long>(g_control.shadow_rays), static_cast<unsigned long long>(g_control.mirror_rays),
        static_cast<unsigned long long>(g_control.refracted_rays), threads);
  }
  return g_signal != 0 ? 128 + g_signal : int(ExitStatus::done);
}

int run_info(const std::string& file, bool as_json) {
  const LoadedScene loaded = load_gltf(file, print_warning);
  const Scene& scene = loaded.scene;
  const Geometry& geometry = scene.geometry;

  std::vector<uint64_t> mesh_triangles;
  uint64_t stored = 0, placed = 0;
  for (const Mesh& mesh : geometry.meshes) {
    uint64_t count = 0;
    for (const TriangleMesh& part : mesh.parts) count += part.triangles.size();
    mesh_triangles.push_back(count);
    stored += count;
  }
  for (const MeshInstance& instance : geometry.mesh_instances) placed += mesh_triangles[instance.mesh];

  nlohmann::ordered_json info;
  info["nodes"] = scene.node_names.size();
  info["meshes"] = geometry.meshes.size();
  info["mesh_instances"] = geometry.mesh_instances.size();
  info["shapes"] = geometry.shapes.size();
  info["shape_instances"] = geometry.shape_instances.size();
  info["triangles"] = stored;
  info["triangles_placed"] = placed;
  info["materials"] = scene.materials.empty() ? 0 : scene.materials.size() - 1;  // without glTF's default
  info["textures"] = scene.textures.size();
  info["images"] = loaded.encoded.size();
  info["lights"] = scene.lights.size();
  const Bounds3d bounds = world_bounds(geometry);
  if (is_empty(bounds)) {
    info["bounds"] = nullptr;
  } else {
    info["bounds"] = {{bounds.lower.x, bounds.lower.y, bounds.lower.z},
                      {bounds.upper.x, bounds.upper.y, bounds.upper.z}};
  }
  info["cameras"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    nlohmann::ordered_json camera;
    camera["index"] = scene.camera_index[i];
    camera["name"] = scene.cameras[i].name;
    camera["kind"] = scene.cameras[i].kind == Camera::Kind::perspective ? "perspective" : "orthographic";
    info["cameras"].push_back(std::move(camera));
  }

  const auto text = [](const nlohmann::ordered_json& value, int indent) {
    return value.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  };
  if (as_json) {
    std::cout << text(info, 2) << '\n';
  } else {
    for (const auto& [key, value] : info.items()) std::cout << key << ": " << text(value, -1) << '\n';
  }
  return int(ExitStatus::done);
}

int run(int argc, char** argv) {
  CLI::App app("Alhazen renders glTF scenes by ray tracing.", "alhazen");
  app.require_subcommand(1);
  app.set_version_flag("--version", [] {
    return "Alhazen " ALHAZEN_VERSION "\n" + traversal_version() + "\nOpenImageIO " OIIO_VERSION_STRING;
  });

  RenderArguments arguments;
  RenderOptions& options = arguments.options;
  CLI::App* render_command = app.add_subcommand("render", "Renders a scene to an image");
  render_command->add_option("SCENE", arguments.scene, "glTF file (.gltf or .glb)")->required();
  render_command->add_option("-o,--output", arguments.output, "Image to write (.exr, .png, .jpg, .tif)")->required();
  render_command->add_option("--size", arguments.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  render_command->add_option("--camera", arguments.camera, "Index in the file's cameras, or name");
  render_command->add_option("--integrator", arguments.integrator, "whitted or signature")
      ->check(CLI::IsMember({"whitted", "signature"}))
      ->capture_default_str();
  render_command->add_option("--max-depth", options.max_depth, "Bounces at most")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  render_command->add_option("--min-weight", options.min_weight, "Rays that count less are not traced")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  render_command->add_option("--spp", options.samples, "Samples for each pixel")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  render_command->add_option("--threads", options.threads, "Threads; 0: all")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  render_command->add_option("--tile-size", options.tile_size, "Pixels along a tile's side")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  render_command->add_option("--background", arguments.background, "Linear r,g,b instead of the scene's");
  render_command->add_option("--ambient", arguments.ambient, "Linear r,g,b instead of the scene's");
  render_command->add_option("--exposure", arguments.exposure, "Stops; colours are multiplied by 2^STOPS");
  render_command
      ->add_option("--lights", arguments.lights, "scene, studio, or auto: studio where the scene has no light")
      ->check(CLI::IsMember({"scene", "studio", "auto"}))
      ->capture_default_str();
  render_command->add_flag("--quiet", arguments.quiet, "Only warnings and errors");

  std::string info_scene;
  bool as_json = false;
  CLI::App* info_command = app.add_subcommand("info", "Says what a scene holds");
  info_command->add_option("SCENE", info_scene, "glTF file (.gltf or .glb)")->required();
  info_command->add_flag("--json", as_json, "As JSON");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == int(CLI::ExitCodes::Success)) return app.exit(error);  // --help, --version
    throw UsageError(error.what());
  }
  return render_command->parsed() ? run_render(arguments) : run_info(info_scene, as_json);
}

int fail(const char* what, ExitStatus status) {
  std::fprintf(stderr, "error: %s\n", what);
  return int(status);
}

}  // namespace
}  // namespace alhazen

int main(int argc, char** argv) {
  using namespace alhazen;
  catch_signals();
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    return fail(error.what(), error.exit_status());
  } catch (const std::bad_alloc&) {
    return fail("out of memory", ExitStatus::input);
  } catch (const std::exception& error) {
    return fail(error.what(), ExitStatus::internal);
  } catch (...) {
    return fail("unknown error", ExitStatus::internal);
  }
}
