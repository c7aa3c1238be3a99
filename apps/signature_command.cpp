#include "apps/signature_command.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/limit_options.h"
#include "apps/prepare_scene.h"
#include "apps/print.h"
#include "core/error.h"
#include "inspect/labels.h"
#include "inspect/legend.h"
#include "inspect/signature.h"
#include "loaders/read_picture.h"
#include "materials/texture.h"

namespace alhazen {
namespace {

using Json = nlohmann::ordered_json;

struct SignatureArguments {
  RenderArguments render;
  std::string other;  // signature to compare with; empty: none
  bool legend = false, json = false;
  const CLI::Option* size = nullptr;
};

std::string hex_color(uint32_t node) {
  const auto c = node_color(node);
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", c[0], c[1], c[2]);
  return text;
}

double share(uint64_t pixels, const IdImage& ids) { return double(pixels) / (double(ids.width) * double(ids.height)); }

Json objects_json(const Scene& scene, const IdImage& ids) {
  Json objects = Json::array();
  for (const auto& [node, pixels] : seen_nodes(ids))
    if (node != kNone)
      objects.push_back({{"node", node},
                         {"name", node_label(scene, node)},
                         {"color", hex_color(node)},
                         {"pixels", pixels},
                         {"share", share(pixels, ids)}});
  return objects;
}

std::string report_json(const SignatureArguments& arguments, const Scene& scene, const IdImage& ids,
                        const std::optional<SignatureDiff>& diff) {
  const auto seen = seen_nodes(ids);
  Json json{{"scene", arguments.render.scene}, {"width", ids.width}, {"height", ids.height}};
  json["objects"] = objects_json(scene, ids);
  json["background"] = !seen.empty() && seen.back().node == kNone ? seen.back().pixels : 0;
  if (diff) json["diff"] = {{"other", arguments.other}, {"nodes", diff->nodes}, {"details", diff->details}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string report_text(const SignatureArguments& arguments, const Scene& scene, const IdImage& ids,
                        const std::optional<SignatureDiff>& diff) {
  std::string text;
  for (const auto& [node, pixels] : seen_nodes(ids)) {
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "%s  %10llu  %8s  ", hex_color(node).c_str(),
                  static_cast<unsigned long long>(pixels), share_text(share(pixels, ids)).c_str());
    text += numbers + node_label(scene, node) + "\n";
  }
  if (!diff) return text;
  if (diff->empty()) return text + "the same as " + arguments.other + "\n";
  return text + std::to_string(diff->nodes) + " pixels show other nodes than " + arguments.other + ", " +
         std::to_string(diff->details) + " others another primitive or material\n";
}

std::vector<LegendRow> legend_rows(const Scene& scene, const IdImage& ids) {
  std::vector<LegendRow> rows;
  for (const auto& [node, pixels] : seen_nodes(ids)) {
    rows.push_back({linear_node_color(node), node_label(scene, node), share_text(share(pixels, ids))});
  }
  return rows;
}

/// The picture of the difference, where one is asked for.
void write(const SignatureArguments& arguments, const Scene& scene, const IdImage& ids,
           const std::optional<SignatureDiff>& diff) {
  const std::string& output = arguments.render.output;
  if (!diff && !arguments.legend) return write_image(output, ids, {}, {});
  ColorImage picture = diff ? diff->picture : node_picture(ids);
  if (arguments.legend) picture = with_legend(picture, legend_rows(scene, ids));
  write_image(output, picture, {}, {});
}

/// What there is to compare with; its size is that of the picture where the command line says none.
std::optional<IdImage> other_signature(SignatureArguments& arguments) {
  if (arguments.other.empty()) return std::nullopt;
  IdImage other = read_signature(arguments.other);
  RenderOptions& options = arguments.render.options;
  if (arguments.size->empty()) options.width = other.width, options.height = other.height;
  if (other.width != options.width || other.height != options.height)
    throw UsageError("--diff: '" + arguments.other + "' is " + std::to_string(other.width) + "x" +
                     std::to_string(other.height) + ", which --size is not");
  return other;
}

void check(const SignatureArguments& arguments) {
  const std::string& output = arguments.render.output;
  if (output.empty() && arguments.legend) throw UsageError("--legend: needs a picture, -o FILE.png");
  if (output.empty()) return;
  const bool linear = image_format(output).linear;
  if (arguments.legend && linear)
    throw UsageError("--legend: '" + output + "' holds numbers; a legend is for .png and the like");
  if (!arguments.other.empty() && linear)
    throw UsageError("--diff: '" + output + "' holds numbers; differences are marked in .png and the like");
}

int run_signature(SignatureArguments arguments) {
  check(arguments);
  RenderArguments& render_arguments = arguments.render;
  render_arguments.options.integrator = Integrator::signature;
  const std::optional<IdImage> other = other_signature(arguments);
  const RenderOptions& options = render_arguments.options;
  if (!render_arguments.output.empty()) check_writable(render_arguments.output, options.width, options.height);

  const PreparedScene prepared(render_arguments);
  RenderControl control;
  const IdImage ids = render(prepared.scene(), *prepared.accelerated, prepared.camera, options, control).ids;
  std::optional<SignatureDiff> diff;
  if (other) diff = difference(ids, *other);
  if (!render_arguments.output.empty()) write(arguments, prepared.scene(), ids, diff);
  print((arguments.json ? report_json : report_text)(arguments, prepared.scene(), ids, diff));
  return int(diff && !diff->empty() ? ExitStatus::regressed : ExitStatus::done);
}

}  // namespace

Command add_signature_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("signature", "Say and show which object each pixel shows")->group("Commands");
  const auto arguments = std::make_shared<SignatureArguments>();
  command->add_option("SCENE", arguments->render.scene, "glTF 2.0 file (.gltf or .glb)")->type_name("")->required();
  command
      ->add_option("-o,--output", arguments->render.output,
                   ".exr: node, primitive and material as integers; .png and others: a colour for each node")
      ->type_name("FILE");
  command->add_flag("--legend", arguments->legend, "A column of colours and names beside the picture");
  command->add_flag("--json", arguments->json, "One JSON object instead of a table");
  command
      ->add_option("--diff", arguments->other,
                   "Compare with this signature; the picture then marks where they disagree: red another node, yellow "
                   "another primitive or material")
      ->type_name("OTHER.exr");
  command->option_defaults()->group("Picture");
  add_view_options(*command, arguments->render);
  arguments->size = command->get_option("--size");
  command->option_defaults()->group("Limits");
  add_limit_options(*command, arguments->render.limits);
  command->footer(
      "Prints the colour, the pixels and the name of each node that is seen.\n"
      "Exit status: 0 done, 6 the signatures differ, 2 wrong usage, 3 bad scene, 4 cannot write.\n"
      "\n"
      "Examples:\n"
      "  alhazen signature scene.gltf -o objects.png --legend\n"
      "  alhazen signature scene.gltf -o ids.exr --json\n"
      "  alhazen signature scene.gltf --watertight --diff ids.exr -o where.png");
  return {command, [arguments] { return run_signature(*arguments); }};
}

}  // namespace alhazen
