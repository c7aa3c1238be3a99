#include "apps/prepare_scene.h"

#include <tbb/parallel_invoke.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "accel/baking.h"
#include "apps/pick_camera.h"
#include "core/fork_join.h"
#include "loaders/environment_file.h"
#include "loaders/image_decode.h"
#include "loaders/image_library.h"
#include "loaders/record_motion.h"

namespace alhazen {
namespace {

/// The environment of the command line.
Environment environment(const RenderArguments& arguments) {
  Environment environment = load_environment(arguments.environment);
  const double angle = double(arguments.environment_rotation) * std::numbers::pi / 180;
  const float c = float(std::cos(angle)), s = float(std::sin(angle));
  environment.environment_from_world = {{c, 0, s}, {0, 1, 0}, {-s, 0, c}, {}};
  environment.strength = arguments.environment_strength;
  return environment;
}

LoadedScene load_still(GltfFile& file, const RenderArguments& arguments) {
  LoadedScene loaded = load_scene(file, arguments);
  bake_single_instances(loaded.scene.geometry, file.moving_meshes());
  open_shutter(file, loaded.scene, arguments);
  return loaded;
}

}  // namespace

void print_warning(const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); }

LoadedScene load_scene(GltfFile& file, const RenderArguments& arguments) {
  if (file.has_images() || !arguments.environment.empty()) preload_image_library();
  LoadedScene loaded = file.load(arguments.time.time.value_or(0));
  if (!arguments.environment.empty()) loaded.scene.environment = environment(arguments);
  return loaded;
}

void set_up_lights(Scene& scene, const Camera& camera, const RenderArguments& arguments) {
  if (arguments.ambient) scene.ambient = *arguments.ambient, scene.has_ambient = true;
  if (arguments.background) scene.background = *arguments.background, scene.has_background = true;
  if (scene.environment && !scene.environment->seen) scene.environment.reset();  // the studio of the frame before
  const bool unlit = scene.lights.empty() && !scene.has_ambient && !scene.environment;
  if (arguments.lights == LightChoice::studio) {
    scene.lights.clear();
    if (arguments.environment.empty()) scene.environment.reset();
  }
  const bool studio = arguments.lights == LightChoice::studio || (arguments.lights == LightChoice::automatic && unlit);
  const bool empty = scene.geometry.mesh_instances.empty() && scene.geometry.shape_instances.empty();
  if (studio && !empty)  // preparing an environment takes longer than all else that an empty scene does
    add_studio_lights(scene, camera);
}

void open_shutter(GltfFile& file, Scene& scene, const RenderArguments& arguments) {
  if (arguments.shutter > 0 && file.is_animated()) record_motion(file, scene, *arguments.time.time, arguments.shutter);
}

BuildOptions build_options(const GltfFile& file, const RenderArguments& arguments, int threads) {
  BuildOptions options{
      .quality = arguments.build, .compact = arguments.compact, .threads = threads, .watertight = arguments.watertight};
  if (file.is_animated()) options.moving = {file.moving_meshes(), file.deforming_meshes(), file.moving_nodes()};
  return options;
}

std::unique_ptr<AcceleratedScene> build_scene(LoadedScene& loaded, const SurfaceFilter& filter,
                                              const BuildOptions& options) {
  std::unique_ptr<AcceleratedScene> accelerated;
  const auto build = [&] { accelerated = std::make_unique<AcceleratedScene>(loaded.scene.geometry, filter, options); };
  if (loaded.encoded.empty()) return build(), std::move(accelerated);
  {
    const ForkJoin order;
    tbb::parallel_invoke(order.task(build), order.task([&] { decode_textures(loaded, print_warning); }));
  }
  return accelerated;
}

PreparedScene::PreparedScene(const RenderArguments& arguments)
    : file(arguments.scene, print_warning, arguments.choice, arguments.time,
           std::make_shared<LoadBudget>(arguments.limits)),
      loaded(load_still(file, arguments)) {
  const RenderOptions& options = arguments.options;
  camera = pick_camera(loaded.scene, arguments.camera, double(options.width) / options.height);
  set_up_lights(loaded.scene, camera, arguments);
  const SurfaceFilter filter = surface_filter(loaded.scene, opacity);
  accelerated = build_scene(loaded, filter, build_options(file, arguments, options.threads));
}

}  // namespace alhazen
