#include "apps/tree_command.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/limit_options.h"
#include "apps/prepare_scene.h"
#include "apps/print.h"
#include "core/error.h"
#include "inspect/trace_pixel.h"
#include "inspect/tree_glb.h"
#include "inspect/tree_html.h"
#include "inspect/tree_json.h"
#include "inspect/tree_svg.h"
#include "inspect/tree_text.h"
#include "loaders/part_file.h"

namespace alhazen {
namespace {

constexpr int kSmallPicture = 480;  // pixels along the longer side, beside the tree

struct TreeArguments {
  RenderArguments render;
  int x = -1, y = -1, sample = 0;
  bool explain = false;
};

void parse_pixel(const std::string& text, TreeArguments& arguments) {
  int used = 0;
  if (std::sscanf(text.c_str(), "%9d,%9d%n", &arguments.x, &arguments.y, &used) != 2 || size_t(used) != text.size() ||
      arguments.x < 0 || arguments.y < 0)
    throw CLI::ValidationError("--pixel", "'" + text + "' is not X,Y, counted from the top left, like 320,180");
}

void check(const TreeArguments& arguments) {
  const RenderOptions& options = arguments.render.options;
  if (arguments.x >= options.width || arguments.y >= options.height)
    throw UsageError("--pixel: the picture has " + std::to_string(options.width) + "x" +
                     std::to_string(options.height) + " pixels, from 0,0 to " + std::to_string(options.width - 1) +
                     "," + std::to_string(options.height - 1));
  if (arguments.sample >= options.samples)
    throw UsageError("--sample: the samples are 0 to " + std::to_string(options.samples - 1) + "; --spp says how many");
}

/// The whole picture, small.
PixelPicture small_picture(const TreeArguments& arguments, const PreparedScene& prepared) {
  RenderOptions options = arguments.render.options;
  const int longer = std::max(options.width, options.height);
  if (longer > kSmallPicture) {
    options.width = std::max(1, options.width * kSmallPicture / longer);
    options.height = std::max(1, options.height * kSmallPicture / longer);
  }
  options.samples = 1;
  RenderControl control;
  return {render(prepared.scene(), *prepared.accelerated, prepared.camera, options, control).color,
          (arguments.x + 0.5) / arguments.render.options.width, (arguments.y + 0.5) / arguments.render.options.height};
}

enum class Form : uint8_t { text, json, svg, html, glb };

Form form_of(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (file.empty() || extension == ".txt") return Form::text;
  if (extension == ".json") return Form::json;
  if (extension == ".svg") return Form::svg;
  if (extension == ".html") return Form::html;
  if (extension == ".glb") return Form::glb;
  throw WriteError(file, "unknown form '" + extension + "'; known are .txt, .json, .svg, .html and .glb");
}

std::string written(Form form, const TreeArguments& arguments, const PreparedScene& prepared, const RayTree& tree) {
  const Scene& scene = prepared.scene();
  switch (form) {
    case Form::json:
      return tree_json(scene, tree, 1);
    case Form::svg:
      return tree_svg(scene, tree);
    case Form::html:
      return tree_html(scene, tree, small_picture(arguments, prepared));
    case Form::glb: {
      const std::vector<uint8_t> bytes = tree_glb(scene, tree);
      return {bytes.begin(), bytes.end()};
    }
    case Form::text:
      break;
  }
  return tree_text(scene, tree, arguments.render.output.empty() && isatty(STDOUT_FILENO) != 0);
}

int run_tree(const TreeArguments& arguments) {
  check(arguments);
  const std::string& output = arguments.render.output;
  const Form form = form_of(output);
  if (!output.empty()) (void)PartFile(output);  // before the work is done
  const PreparedScene prepared(still_arguments(arguments.render));
  const RayTree tree = trace_pixel(prepared.scene(), *prepared.accelerated, prepared.camera, arguments.render.options,
                                   arguments.x, arguments.y, arguments.sample);
  if (arguments.explain) print(explanation(prepared.scene(), tree));
  if (output.empty()) {
    if (!arguments.explain) print(written(form, arguments, prepared, tree));
    return int(ExitStatus::done);
  }
  const std::string text = written(form, arguments, prepared, tree);
  PartFile part(output);
  part.write({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  part.commit();
  return int(ExitStatus::done);
}

}  // namespace

Command add_tree_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("tree", "Say why a pixel has its value: the rays that it is made of")->group("Commands");
  const auto arguments = std::make_shared<TreeArguments>();
  command->add_option("SCENE", arguments->render.scene, "glTF 2.0 file (.gltf or .glb)")->type_name("")->required();
  command
      ->add_option_function<std::string>(
          "--pixel", [arguments](const std::string& text) { parse_pixel(text, *arguments); },
          "Which, counted from 0,0 at the top left")
      ->type_name("X,Y")
      ->required();
  command->add_option("--sample", arguments->sample, "Which of the pixel's samples")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber.description(""))
      ->capture_default_str();
  command
      ->add_option("-o,--output", arguments->render.output,
                   "The tree as text (.txt), data (.json), drawing (.svg), a page with the picture (.html), or "
                   "its rays as a scene (.glb); by default text to standard output")
      ->type_name("FILE");
  command->add_flag("--explain", arguments->explain, "A few sentences instead: what is seen, through what");
  command->option_defaults()->group("Picture");
  add_view_options(*command, arguments->render);
  add_tracing_options(*command, arguments->render);
  command->option_defaults()->group("Light");
  add_light_options(*command, arguments->render);
  command->option_defaults()->group("Limits");
  add_limit_options(*command, arguments->render.limits);
  command->footer(
      "The options are those of `alhazen render`; the light of all rays adds up to that picture's pixel,\n"
      "bit for bit.\n"
      "Exit status: 0 done, 2 wrong usage, 3 bad scene, 4 cannot write.\n"
      "\n"
      "Examples:\n"
      "  alhazen tree scene.gltf --pixel 640,360\n"
      "  alhazen tree scene.gltf --pixel 640,360 --explain\n"
      "  alhazen tree scene.gltf --pixel 320,180 --size 640x360 --spp 16 --sample 3 -o tree.html");
  return {command, [arguments] { return run_tree(*arguments); }};
}

}  // namespace alhazen
