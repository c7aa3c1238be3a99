#include "apps/make_command.h"

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "apps/usage.h"
#include "core/error.h"
#include "loaders/part_file.h"
#include "procedural/databases.h"
#include "procedural/nff_reader.h"
#include "procedural/nff_to_gltf.h"

namespace alhazen {
namespace {

struct MakeArguments {
  std::string input, output;
  int size = 0;  // 0: the database's own
  GltfForm form;
};

int write_glb(const NffScene& scene, const MakeArguments& arguments) {
  PartFile part(arguments.output);
  const std::vector<uint8_t> glb = glb_of(scene, arguments.form);
  if (glb.size() > UINT32_MAX) throw WriteError(arguments.output, "would be larger than a GLB file may be, 4 GiB");
  part.write(glb);
  part.commit();
  std::printf("%s: %zu spheres, %zu cones, %zu polygons, %zu lights\n", arguments.output.c_str(), scene.spheres.size(),
              scene.cones.size(), scene.polygons.size(), scene.lights.size());
  return int(ExitStatus::done);
}

int run_make(const MakeArguments& arguments) {
  std::vector<std::string> names;
  for (const Database& database : databases()) {
    if (database.name != arguments.input) {
      names.push_back(database.name);
      continue;
    }
    const int size = arguments.size > 0 ? arguments.size : database.default_size;
    if (size > database.largest_size)
      throw UsageError("--size of " + database.name + " is " + std::to_string(database.largest_size) + " at most");
    return write_glb(database.make(size), arguments);
  }
  throw UsageError("unknown scene '" + arguments.input + "', expected one of " + joined(names) +
                   did_you_mean(arguments.input, names));
}

int run_convert(const MakeArguments& arguments) {
  std::ifstream in(arguments.input);
  if (!in) throw LoadError(arguments.input, "", "cannot be read");
  return write_glb(read_nff(in, arguments.input), arguments);
}

void add_output_options(CLI::App& command, MakeArguments& arguments) {
  command.add_option("-o,--output", arguments.output, "The .glb file")->type_name("FILE")->required();
  command.add_flag("--tessellate", arguments.form.tessellate,
                   "Spheres and cones as triangles; else exact, which needs a viewer that knows ALHAZEN_shapes");
  command.add_option("--segments", arguments.form.segments, "Around a sphere or cone that is tessellated")
      ->type_name("N")
      ->check(CLI::Range(3, 4096).description(""))
      ->capture_default_str();
}

std::string database_list() {
  std::string text;
  char line[160];
  for (const Database& d : databases()) {
    std::snprintf(line, sizeof line, "  %-9s %2d  %s\n", d.name.c_str(), d.default_size, d.description.c_str());
    text += line;
  }
  return text;
}

}  // namespace

Command add_make_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("make", "Make a well-known benchmark scene")->group("Commands");
  const auto arguments = std::make_shared<MakeArguments>();
  command->add_option("NAME", arguments->input, "Which scene")->required();
  command->add_option("--size", arguments->size, "How large: levels or divisions; by default as in the literature")
      ->type_name("N")
      ->check(CLI::Range(1, 1000).description(""));
  add_output_options(*command, *arguments);
  command->footer("Haines' Standard Procedural Databases, with their usual sizes:\n" + database_list() +
                  "\nExamples:\n"
                  "  alhazen make balls -o balls.glb\n"
                  "  alhazen make rings --size 20 --tessellate -o rings.glb");
  return {command, [arguments] { return run_make(*arguments); }};
}

Command add_convert_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("convert", "Turn a .nff scene into glTF")->group("Commands");
  const auto arguments = std::make_shared<MakeArguments>();
  command->add_option("SCENE", arguments->input, "Neutral File Format (.nff)")->type_name("")->required();
  add_output_options(*command, *arguments);
  command->footer("Example:\n  alhazen convert balls.nff -o balls.glb");
  return {command, [arguments] { return run_convert(*arguments); }};
}

}  // namespace alhazen
