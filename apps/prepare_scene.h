// From the options of a command line to a scene that is ready to be traced.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accel/accelerated_scene.h"
#include "apps/render_arguments.h"
#include "loaders/gltf_file.h"

namespace alhazen {

/// On standard error.
void print_warning(const std::string& text);

/// The scene at the arguments' time, in their environment. What decodes images is loaded meanwhile, where there are
/// any.
[[nodiscard]] LoadedScene load_scene(GltfFile& file, const RenderArguments& arguments);

/// The lights and background that the arguments ask for; studio lights where there would be none.
void set_up_lights(Scene& scene, const Camera& camera, const RenderArguments& arguments);

/// Gives what the file's animations move its motion, from the arguments' time on, at which the scene stands, for as
/// long as the shutter stays open.
void open_shutter(GltfFile& file, Scene& scene, const RenderArguments& arguments);

/// What `build_scene` is told of the file and the arguments. Refers to the file.
[[nodiscard]] BuildOptions build_options(const GltfFile& file, const RenderArguments& arguments, int threads);

/// Builds the hierarchies while the textures are decoded, if they are not yet.
[[nodiscard]] std::unique_ptr<AcceleratedScene> build_scene(LoadedScene& loaded, const SurfaceFilter& filter,
                                                            const BuildOptions& options);

/// One scene, its camera and lights, where a command needs no more than a still. Stays where it is: what is built reads
/// the scene in place.
struct PreparedScene {
  GltfFile file;
  LoadedScene loaded;
  Camera camera;
  std::vector<Opacity> opacity;
  std::unique_ptr<AcceleratedScene> accelerated;

  /// Throws LoadError for a scene that cannot be read, UsageError for a choice that it does not have.
  explicit PreparedScene(const RenderArguments& arguments);
  PreparedScene(const PreparedScene&) = delete;
  PreparedScene& operator=(const PreparedScene&) = delete;
  [[nodiscard]] const Scene& scene() const { return loaded.scene; }
};

}  // namespace alhazen
