#include "apps/usage.h"

namespace alhazen {
namespace {

/// The command that the command line names, or the program itself.
const CLI::App& named_command(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? program : *commands.back();
}

std::string help_hint(const CLI::App& program, const CLI::App& command) {
  const std::string name = &command == &program ? "" : " " + command.get_name();
  return " (see " + program.get_name() + name + " --help)";
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string explain(const CLI::App& program, const CLI::App& command, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = program.remaining(true);
  for (const std::string& argument : unknown)
    if (argument.size() > 1 && argument[0] == '-') {
      const std::string name = argument.substr(0, argument.find('='));
      return "unknown option '" + name + "'" + did_you_mean(name, option_names(command));
    }
  if (&command == &program) {
    const std::vector<std::string> known = command_names(program);
    if (unknown.empty()) return "expected a command: " + joined(known);
    return "unknown command '" + unknown[0] + "', expected one of " + joined(known) + did_you_mean(unknown[0], known);
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) return "unexpected argument '" + unknown.at(0) + "'";
  return error.what();
}

}  // namespace

UsageError usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& command = named_command(program);
  return UsageError(explain(program, command, error) + help_hint(program, command));
}

}  // namespace alhazen
