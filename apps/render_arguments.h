// The options of `alhazen render`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "accel/build_quality.h"
#include "apps/frame_range.h"
#include "apps/progress.h"
#include "apps/view_transform.h"
#include "core/vec.h"
#include "loaders/color_config.h"
#include "loaders/gltf_file.h"
#include "loaders/image_file.h"
#include "renderer/render.h"

namespace alhazen {

enum class LightChoice : uint8_t { automatic, scene, studio };

struct RenderArguments {
  std::string scene, output;
  SceneChoice choice;
  LoadLimits limits;
  TimeChoice time;
  std::optional<FrameRange> frames;  // none: a still
  double fps = 24;                   // frames of a second
  double shutter = 0;                // seconds for which it stays open from the time on; 0: it takes a moment
  std::string camera;                // index or name; empty: the scene's first
  RenderOptions options;
  bool watertight = false;
  BuildQuality build = BuildQuality::balanced;
  bool compact = false;
  LightChoice lights = LightChoice::automatic;
  std::optional<Rgb> background, ambient;
  std::string environment;         // file; empty: none
  float environment_rotation = 0;  // degrees, from above against the clock
  float environment_strength = 1;
  float exposure = 0;  // stops
  ViewTransform view = ViewTransform::standard;
  DisplayView ocio;  // where it names a configuration, its view takes the place of `view`
  ImageEncoding encoding;
  bool multipart = false;  // a part of the file for each layer
  ProgressStyle progress = ProgressStyle::automatic;
  bool quiet = false;
};

/// Fills `arguments`, which must live as long as `command`, when the command line is parsed.
void add_render_options(CLI::App& command, RenderArguments& arguments);

/// The groups of them that other commands share: what is seen from where, how far it is followed, what lights it.
void add_view_options(CLI::App& command, RenderArguments& arguments);
void add_tracing_options(CLI::App& command, RenderArguments& arguments);
void add_light_options(CLI::App& command, RenderArguments& arguments);

/// --build and --compact; what they are given must live as long as `command`.
void add_build_options(CLI::App& command, BuildQuality& quality, bool& compact);

/// "fast", "balanced", "best"
[[nodiscard]] const char* build_quality_name(BuildQuality quality);

/// --size, whose default `options` holds; it must live as long as `command`.
void add_size_option(CLI::App& command, RenderOptions& options);

/// Throws UsageError for options that do not go together.
void check_arguments(const RenderArguments& arguments);

/// The arguments of one frame of a sequence: a still at its time, in a file of its own.
[[nodiscard]] RenderArguments frame_arguments(const RenderArguments& sequence, int frame);

/// The arguments of a still: a shutter that opens without a time opens at 0 s.
[[nodiscard]] RenderArguments still_arguments(const RenderArguments& arguments);

/// The options that decide on the pixels, defaults too, as a command line would give them.
[[nodiscard]] std::string picture_options(const RenderArguments& arguments);

}  // namespace alhazen
