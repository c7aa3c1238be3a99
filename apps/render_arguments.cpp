#include "apps/render_arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdio>

#include "apps/limit_options.h"
#include "apps/usage.h"

namespace alhazen {
namespace {

constexpr int kLargestSide = 65536;
const std::vector<std::string> kViews{"standard", "pbr-neutral", "agx", "aces", "none"};  // as ViewTransform has them

void parse_size(const std::string& text, RenderOptions& options) {
  int width = 0, height = 0, used = 0;
  const auto valid = [](int side) { return side >= 1 && side <= kLargestSide; };
  if (std::sscanf(text.c_str(), "%6dx%6d%n", &width, &height, &used) != 2 || size_t(used) != text.size() ||
      !valid(width) || !valid(height))
    throw CLI::ValidationError("--size", "'" + text + "' is not WIDTHxHEIGHT, both in 1 to 65536, like 1920x1080");
  options.width = width, options.height = height;
}

Rgb parse_color(const std::string& option, const std::string& text) {
  Rgb color;
  int used = 0;
  const int found = std::sscanf(text.c_str(), "%f,%f,%f%n", &color.r, &color.g, &color.b, &used);
  const auto valid = [](float v) { return std::isfinite(v) && v >= 0; };
  if (found != 3 || size_t(used) != text.size() || !valid(color.r) || !valid(color.g) || !valid(color.b))
    throw CLI::ValidationError(option,
                               "'" + text + "' is not three numbers R,G,B, finite and not negative, like 0.2,0.4,0.8");
  return color;
}

void add_color(CLI::App& command, const std::string& name, std::optional<Rgb>& color, const std::string& description) {
  command
      .add_option_function<std::string>(
          name, [&color, name](const std::string& text) { color = parse_color(name, text); }, description)
      ->type_name("R,G,B");
}

CLI::Validator finite() {
  return {[](std::string& text) {
            return std::isfinite(std::strtod(text.c_str(), nullptr)) ? "" : "'" + text + "' is not a finite number";
          },
          ""};
}

CLI::Validator duration() {
  return {[](std::string& text) {
            char* end = nullptr;
            const double seconds = std::strtod(text.c_str(), &end);
            const bool valid = end != text.c_str() && *end == 0 && std::isfinite(seconds) && seconds >= 0;
            return valid ? "" : "'" + text + "' is not a time in seconds, 0 or more, like 0.02";
          },
          ""};
}

std::string layer_names() {
  std::string names;
  for (size_t i = 0; i < kLayers; ++i) names += (i > 0 ? ", " : "") + std::string(layer_name(Layer(i)));
  return names;
}

std::vector<Layer> parse_layers(const std::string& text) {
  std::vector<std::string> known;
  for (size_t i = 0; i < kLayers; ++i) known.emplace_back(layer_name(Layer(i)));
  std::vector<Layer> layers;
  for (const std::string& word : CLI::detail::split(text, ',')) {
    const auto at = std::ranges::find(known, word);
    if (at == known.end())
      throw CLI::ValidationError(
          "--aov", "unknown '" + word + "', expected some of " + joined(known) + did_you_mean(word, known));
    const auto layer = Layer(at - known.begin());
    if (std::ranges::find(layers, layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

void add_layer_options(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option_function<std::string>(
          "--aov", [&](const std::string& text) { arguments.options.layers = parse_layers(text); },
          "Layers, in the channels of an .exr file, or one alone as an 8-bit picture: some of " + layer_names())
      ->type_name("LIST");
  command.add_flag("--multipart", arguments.multipart, "--aov: a part of the .exr file for each layer");
}

void add_frame_options(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option_function<std::string>(
          "--frames", [&](const std::string& text) { arguments.frames = parse_frames(text); },
          "A sequence: frame N is at N / fps seconds, in the file whose name has N in place of ####")
      ->type_name("FIRST:LAST[:STEP]");
  command.add_option("--fps", arguments.fps, "Frames of a second")
      ->type_name("N")
      ->check(finite())
      ->check(CLI::PositiveNumber.description(""))
      ->capture_default_str();
}

void add_picture_options(CLI::App& command, RenderArguments& arguments) {
  add_view_options(command, arguments);
  add_frame_options(command, arguments);
  add_choice<Integrator>(command, "--integrator", arguments.options.integrator,
                         {{"whitted", Integrator::whitted}, {"signature", Integrator::signature}},
                         "What a pixel shows: light, or which node, primitive and material are seen");
  add_tracing_options(command, arguments);
}

void add_display_options(CLI::App& command, RenderArguments& arguments) {
  command.add_option("--exposure", arguments.exposure, "Stops brighter (or darker): colours are multiplied by 2^STOPS")
      ->type_name("STOPS")
      ->check(finite())
      ->default_str("0");
  const auto choose = [&](const std::string& name) {
    arguments.ocio.view = name;
    const auto at = std::find(kViews.begin(), kViews.end(), name);
    if (at != kViews.end()) arguments.view = ViewTransform(at - kViews.begin());
  };
  command
      .add_option_function<std::string>(
          "--view", choose,
          "How 8-bit files show the light: standard clamps, pbr-neutral, agx and aces compress highlights, none writes "
          "linear numbers; with --ocio, a view of its configuration")
      ->type_name("NAME")
      ->default_str(kViews[0]);
  command.add_option("--ocio", arguments.ocio.config, "OpenColorIO configuration whose views 8-bit files are shown by")
      ->type_name("FILE");
  command
      .add_option("--display", arguments.ocio.display, "With --ocio: one of its displays, by default its own choice")
      ->type_name("NAME");
}

/// The views that are asked for are there; those of a configuration are looked for in it.
void check_view(const RenderArguments& arguments) {
  const DisplayView& ocio = arguments.ocio;
  if (!ocio.config.empty()) return check_display_view(ocio);
  if (!ocio.display.empty()) throw UsageError("--display: needs --ocio, the configuration that has it");
  if (!ocio.view.empty() && std::find(kViews.begin(), kViews.end(), ocio.view) == kViews.end())
    throw UsageError("--view: unknown '" + ocio.view + "', expected one of " + joined(kViews) +
                     did_you_mean(ocio.view, kViews));
}

void add_file_options(CLI::App& command, RenderArguments& arguments) {
  command.add_option("-o,--output", arguments.output, "Picture to write; its name chooses the format")
      ->type_name("FILE")
      ->required();
  command.add_flag("--transparent", arguments.options.transparent,
                   "Alpha instead of the background where the camera sees it (.exr .png .tif .webp .tga)");
  add_layer_options(command, arguments);
  command.add_flag("--half", arguments.encoding.half, ".exr: 16-bit floats instead of 32");
  command
      .add_option("--compression", arguments.encoding.compression,
                  ".exr: zip (default), none, rle, zips, piz, and lossy pxr24, b44, b44a, dwaa, dwab; "
                  ".tif: zip (default), none, lzw, packbits")
      ->type_name("NAME");
  command.add_option("--quality", arguments.encoding.quality, ".jpg .webp: 1 to 100")
      ->type_name("N")
      ->check(CLI::Range(1, 100).description(""))
      ->default_str("95");
}

void add_run_options(CLI::App& command, RenderArguments& arguments) {
  command.add_option("--threads", arguments.options.threads, "Threads; 0: one for each processor")
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""))
      ->capture_default_str();
  command.add_option("--tile-size", arguments.options.tile_size, "Side of a tile in pixels; never changes the picture")
      ->type_name("N")
      ->check(CLI::Range(1, kLargestSide).description(""))
      ->capture_default_str();
  add_choice<ProgressStyle>(command, "--progress", arguments.progress,
                            {{"auto", ProgressStyle::automatic},
                             {"plain", ProgressStyle::plain},
                             {"json", ProgressStyle::json},
                             {"none", ProgressStyle::none}},
                            "auto: one line on a terminal, plain lines elsewhere; json: an object a line on standard "
                            "output");
  command.add_flag("--quiet", arguments.quiet, "Only warnings and errors");
}

/// The shortest text that reads back as the same number.
template <std::floating_point T>
std::string number(T v) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, v).ptr};
}

std::string number(const Rgb& c) { return number(c.r) + "," + number(c.g) + "," + number(c.b); }

void check_layers(const RenderArguments& arguments) {
  const size_t layers = arguments.options.layers.size();
  const bool exr = image_format(arguments.output).name == "openexr";
  if (arguments.multipart && (layers == 0 || !exr)) throw UsageError("--multipart: needs --aov and an .exr file");
  if (layers == 0) return;
  if (arguments.options.integrator == Integrator::signature) throw UsageError("--aov: a signature has no layers");
  const Layer first = arguments.options.layers[0];
  const bool several = layers > 1 || first == Layer::lights;
  if (!exr && (several || image_format(arguments.output).linear))
    throw UsageError("--aov: '" + arguments.output +
                     "' cannot hold layers; .exr can, and .png and the like show one alone");
}

}  // namespace

void add_size_option(CLI::App& command, RenderOptions& options) {
  command
      .add_option_function<std::string>(
          "--size", [&options](const std::string& text) { parse_size(text, options); }, "Size of the picture in pixels")
      ->type_name("WxH")
      ->default_str(std::to_string(options.width) + "x" + std::to_string(options.height));
}

void add_view_options(CLI::App& command, RenderArguments& arguments) {
  add_size_option(command, arguments.options);
  command
      .add_option("--camera", arguments.camera,
                  "Index in the file's cameras, or a name; by default the scene's first, or one that shows it all")
      ->type_name("INDEX|NAME");
  command
      .add_option("--scene", arguments.choice.scene,
                  "Index or name of one of the file's scenes; by default its own choice")
      ->type_name("INDEX|NAME");
  command
      .add_option("--variant", arguments.choice.variant,
                  "Index or name of a variant of the materials (KHR_materials_variants)")
      ->type_name("INDEX|NAME");
  command
      .add_option("--animation", arguments.time.animation,
                  "Index or name of an animation, all, or none: the rest pose; by default none, with a time the first")
      ->type_name("INDEX|NAME");
  command.add_option("--time", arguments.time.time, "Seconds into the animation")
      ->type_name("SECONDS")
      ->check(finite());
  command.add_flag("--watertight", arguments.watertight,
                   "Triangles of our own in place of Embree's: no ray slips through a closed mesh; slower");
}

void add_tracing_options(CLI::App& command, RenderArguments& arguments) {
  RenderOptions& options = arguments.options;
  command
      .add_option("--shutter", arguments.shutter,
                  "Motion blur: the shutter opens at the time, or at each frame's, and stays open for so long")
      ->type_name("SECONDS")
      ->check(duration())
      ->default_str("0");
  command.add_option("--spp", options.samples, "Samples per pixel; 1 takes the pixel's centre")
      ->type_name("N")
      ->check(CLI::Range(1, 65536).description(""))
      ->capture_default_str();
  command.add_option("--max-depth", options.max_depth, "How often a ray may be mirrored or refracted on its way")
      ->type_name("N")
      ->check(CLI::Range(0, 1000).description(""))
      ->capture_default_str();
  command.add_option("--min-weight", options.min_weight, "A ray that counts less than this in its pixel is not traced")
      ->type_name("X")
      ->check(finite())
      ->check(CLI::NonNegativeNumber.description(""))
      ->capture_default_str();
}

void add_light_options(CLI::App& command, RenderArguments& arguments) {
  add_choice<LightChoice>(
      command, "--lights", arguments.lights,
      {{"auto", LightChoice::automatic}, {"scene", LightChoice::scene}, {"studio", LightChoice::studio}},
      "The scene's lights, or three studio lights about the camera; auto: studio where the scene has none");
  add_color(command, "--background", arguments.background, "Linear colour behind everything, instead of the scene's");
  add_color(command, "--ambient", arguments.ambient, "Linear ambient light, instead of the scene's");
  command
      .add_option("--environment", arguments.environment,
                  "Equirectangular image (.hdr, .exr) that lights the scene and is its background")
      ->type_name("FILE");
  command
      .add_option("--environment-rotation", arguments.environment_rotation,
                  "Turns it about the vertical axis, seen from above against the clock")
      ->type_name("DEG")
      ->check(finite())
      ->default_str("0");
  command.add_option("--environment-strength", arguments.environment_strength, "Multiplies its light")
      ->type_name("X")
      ->check(finite())
      ->check(CLI::NonNegativeNumber.description(""))
      ->default_str("1");
}

void add_render_options(CLI::App& command, RenderArguments& arguments) {
  command.add_option("SCENE", arguments.scene, "glTF 2.0 file (.gltf or .glb)")->type_name("")->required();
  const auto group = [&](const char* name) { command.option_defaults()->group(name); };
  group("File"), add_file_options(command, arguments);
  group("Picture"), add_picture_options(command, arguments);
  group("Light"), add_light_options(command, arguments), add_display_options(command, arguments);
  group("Run"), add_run_options(command, arguments);
  group("Limits"), add_limit_options(command, arguments.limits);
}

void check_arguments(const RenderArguments& arguments) {
  if (arguments.frames && arguments.time.time) throw UsageError("--time: frames have times of their own");
  if (arguments.frames && !has_frame_place(arguments.output))
    throw UsageError("--frames: '" + arguments.output + "' has no place for the number, like out.####.exr");
  check_encoding(arguments.output, arguments.encoding);
  const bool ids = arguments.options.integrator == Integrator::signature;
  check_view(arguments);
  const bool viewed = arguments.view != ViewTransform::standard || !arguments.ocio.config.empty();
  if (viewed && image_format(arguments.output).linear)
    throw UsageError("--view: '" + arguments.output + "' stays scene-linear; views are for 8-bit files");
  if (ids && arguments.shutter > 0) throw UsageError("--shutter: a signature shows one moment");
  check_layers(arguments);
  if (ids && arguments.encoding.half) throw UsageError("--half: a signature holds 32-bit integers");
  if (!arguments.options.transparent) return;
  if (ids) throw UsageError("--transparent: a signature has no alpha");
  if (!image_format(arguments.output).alpha)
    throw UsageError("--transparent: '" + arguments.output + "' cannot hold alpha; .exr, .png, .tif and .webp can");
}

RenderArguments frame_arguments(const RenderArguments& sequence, int frame) {
  RenderArguments still = sequence;
  still.frames.reset();
  still.output = frame_file(sequence.output, frame);
  still.time.time = frame / sequence.fps;
  return still;
}

RenderArguments still_arguments(const RenderArguments& arguments) {
  RenderArguments still = arguments;
  if (still.shutter > 0 && !still.time.time) still.time.time = 0;
  return still;
}

std::string picture_options(const RenderArguments& arguments) {
  const RenderOptions& options = arguments.options;
  std::string text = "--size " + std::to_string(options.width) + "x" + std::to_string(options.height);
  if (arguments.limits.ignore_required) text += " --ignore-required";
  if (!arguments.choice.scene.empty()) text += " --scene '" + arguments.choice.scene + "'";
  if (!arguments.choice.variant.empty()) text += " --variant '" + arguments.choice.variant + "'";
  if (!arguments.time.animation.empty()) text += " --animation '" + arguments.time.animation + "'";
  if (arguments.time.time) text += " --time " + number(*arguments.time.time);
  if (arguments.shutter > 0) text += " --shutter " + number(arguments.shutter);
  if (!arguments.camera.empty()) text += " --camera '" + arguments.camera + "'";
  text += options.integrator == Integrator::signature ? " --integrator signature" : " --integrator whitted";
  text += " --spp " + std::to_string(options.samples) + " --max-depth " + std::to_string(options.max_depth) +
          " --min-weight " + number(options.min_weight);
  constexpr const char* kLights[] = {"auto", "scene", "studio"};
  text += std::string(" --lights ") + kLights[size_t(arguments.lights)];
  if (arguments.background) text += " --background " + number(*arguments.background);
  if (arguments.ambient) text += " --ambient " + number(*arguments.ambient);
  if (!arguments.environment.empty())
    text += " --environment '" + arguments.environment + "' --environment-rotation " +
            number(arguments.environment_rotation) + " --environment-strength " +
            number(arguments.environment_strength);
  text += " --exposure " + number(arguments.exposure);
  if (!arguments.ocio.config.empty()) {
    text += " --ocio '" + arguments.ocio.config + "'";
    if (!arguments.ocio.display.empty()) text += " --display '" + arguments.ocio.display + "'";
    if (!arguments.ocio.view.empty()) text += " --view '" + arguments.ocio.view + "'";
  } else if (arguments.view != ViewTransform::standard) {
    text += " --view " + kViews[size_t(arguments.view)];
  }
  if (options.transparent) text += " --transparent";
  if (arguments.watertight) text += " --watertight";
  return text;
}

}  // namespace alhazen
