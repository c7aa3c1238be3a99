// The command line: one command a file, each a row of `kCommands`.
#include <oneapi/tbb/version.h>

#include <cstdio>
#include <memory>
#include <new>

#include "accel/accelerated_scene.h"
#include "apps/bench_command.h"
#include "apps/brdf_command.h"
#include "apps/crosscheck_command.h"
#include "apps/help_formatter.h"
#include "apps/info_command.h"
#include "apps/interruption.h"
#include "apps/make_command.h"
#include "apps/render_command.h"
#include "apps/sheet_command.h"
#include "apps/signature_command.h"
#include "apps/tree_command.h"
#include "apps/usage.h"
#include "core/error.h"
#include "loaders/image_file.h"
#include "loaders/image_library.h"

namespace alhazen {
namespace {

constexpr Command (*kCommands[])(CLI::App& program) = {
    add_render_command, add_info_command,  add_signature_command,  add_tree_command, add_brdf_command,
    add_sheet_command,  add_bench_command, add_crosscheck_command, add_make_command, add_convert_command,
};

std::string version() {
  return "Alhazen " ALHAZEN_VERSION "\n" + traversal_version() + "\noneTBB " + TBB_runtime_version() + "\n" +
         image_library_versions();
}

int run(int argc, char** argv) {
  CLI::App program("Alhazen renders glTF 2.0 scenes by ray tracing.", "alhazen");
  program.require_subcommand(1);
  program.set_version_flag("--version", version, "Print the versions of the program and its libraries")->group("Help");
  program.set_help_flag("-h,--help", "Print this help")->group("Help");
  program.formatter(std::make_shared<HelpFormatter>());
  program.footer("Example:\n  alhazen render scene.gltf -o scene.png\n\n`alhazen COMMAND --help` says more.");
  program.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  std::vector<Command> commands;
  for (const auto add : kCommands) commands.push_back(add(program));
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == int(CLI::ExitCodes::Success)) return program.exit(error);  // --help, --version
    throw usage_error(program, error);
  }
  for (const Command& command : commands)
    if (command.parser->parsed()) return command.run();
  return int(ExitStatus::internal);
}

int fail(const char* what, ExitStatus status) {
  std::fprintf(stderr, "error: %s\n", what);
  return int(status);
}

int run_or_fail(int argc, char** argv) {
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

}  // namespace
}  // namespace alhazen

int main(int argc, char** argv) {
  alhazen::catch_signals();
  const int status = alhazen::run_or_fail(argc, argv);
  alhazen::await_image_library();
  return status;
}
