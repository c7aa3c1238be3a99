#include "apps/sheet_command.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "apps/child_render.h"
#include "apps/contact_sheet.h"
#include "apps/interruption.h"
#include "apps/render_arguments.h"
#include "apps/scratch_folder.h"
#include "core/error.h"
#include "loaders/image_file.h"
#include "loaders/read_picture.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> g_stop{false};  // lives as long as the program, as the signal handler wants

struct SheetArguments {
  std::string folder, output, render_options;
  RenderOptions cell{.width = 320, .height = 240};
  int columns = 0;
  double limit_s = 60;
};

bool is_model(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".gltf" || extension == ".glb";
}

/// Relative to the folder, in the order of their names.
std::vector<fs::path> models_below(const fs::path& folder) {
  std::vector<fs::path> models;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied))
      if (is_model(entry.path()) && entry.is_regular_file()) models.push_back(entry.path().lexically_relative(folder));
  } catch (const fs::filesystem_error& error) {
    throw LoadError(folder.string(), "", error.code().message());
  }
  if (models.empty()) throw LoadError(folder.string(), "", "holds no .gltf or .glb file");
  std::ranges::sort(models);
  return models;
}

std::string facts_of(const ChildRender& run) {
  if (run.status != 0) return run.error;
  char text[128];
  std::snprintf(text, sizeof text, "load %.2f s, render %.2f s, %.0f MB%s", run.load_s + run.build_s, run.render_s,
                1e-6 * double(run.peak_bytes), run.warnings.empty() ? "" : ", warns");
  return text;
}

SheetCell render_cell(const SheetArguments& arguments, const fs::path& model, const fs::path& scratch) {
  const fs::path picture = scratch / "picture.png";
  std::vector<std::string> options = CLI::detail::split_up(arguments.render_options);
  options.insert(options.begin(),
                 {"--size", std::to_string(arguments.cell.width) + "x" + std::to_string(arguments.cell.height)});
  const ChildRender run =
      render_in_child(fs::path(arguments.folder) / model, picture, options, scratch, arguments.limit_s, g_stop);
  SheetCell cell{model.string(), facts_of(run), {}, run.status != 0};
  if (!cell.failed) cell.picture = read_picture(picture);
  std::printf("%s: %s\n", model.c_str(), cell.facts.c_str());
  std::fflush(stdout);
  return cell;
}

int run_sheet(const SheetArguments& arguments) {
  const std::vector<fs::path> models = models_below(arguments.folder);
  const SheetLayout layout{arguments.cell.width, arguments.cell.height, arguments.columns};
  const auto [width, height] = sheet_size(layout, models.size());
  check_writable(arguments.output, width, height);
  stop_on_signal(g_stop);
  const ScratchFolder scratch;
  std::vector<SheetCell> cells;
  size_t failed = 0;
  for (const fs::path& model : models) {
    SheetCell cell = render_cell(arguments, model, scratch.path());
    if (g_stop) break;
    failed += cell.failed;
    cells.push_back(std::move(cell));
  }
  if (!cells.empty()) write_image(arguments.output, contact_sheet(layout, cells), {}, {});
  std::printf("%s%zu of %zu models rendered\n", g_stop ? "interrupted, " : "", cells.size() - failed, models.size());
  if (g_stop) return 128 + caught_signal();
  return int(failed > 0 ? ExitStatus::input : ExitStatus::done);
}

}  // namespace

Command add_sheet_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("sheet", "Render every model below a folder to one page")->group("Commands");
  const auto arguments = std::make_shared<SheetArguments>();
  command->add_option("FOLDER", arguments->folder, "Where .gltf and .glb files are looked for")->required();
  command->add_option("-o,--output", arguments->output, "The page: .png, .jpg, .exr or another image")
      ->type_name("FILE")
      ->required();
  add_size_option(*command, arguments->cell);
  command->add_option("--columns", arguments->columns, "Pictures in a row; 0: a page about as wide as high")
      ->type_name("N")
      ->check(CLI::Range(0, 1000).description(""))
      ->capture_default_str();
  command->add_option("--timeout", arguments->limit_s, "A model that takes longer is given up")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber.description(""))
      ->capture_default_str();
  command->add_option("--render-options", arguments->render_options, "More options of `alhazen render`, in one word")
      ->type_name("TEXT");
  command->footer(
      "Under each picture: the file, seconds until the first ray and of rendering, peak memory, or why\n"
      "there is none. Every model is rendered by a process of its own.\n"
      "Ctrl-C makes the page of what is there.\n"
      "Exit status: 0 all are rendered, 3 some are not, 2 wrong usage, 4 cannot write, 130 or 143 stopped.\n"
      "\n"
      "Examples:\n"
      "  alhazen sheet models -o models.png\n"
      "  alhazen sheet models -o models.jpg --size 480x360 --render-options '--spp 16 --view agx'");
  return {command, [arguments] { return run_sheet(*arguments); }};
}

}  // namespace alhazen
