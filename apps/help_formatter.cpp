#include "apps/help_formatter.h"

#include <sstream>
#include <utility>

namespace alhazen {
namespace {

constexpr size_t kColumn = 28, kWidth = 100;

/// `left`, and `text` in the second column, broken between words; `last` stays in one piece.
std::string two_columns(const std::string& left, const std::string& text, const std::string& last) {
  std::string out = left;
  size_t used = left.size();
  const auto to_second_column = [&] {
    if (used >= kColumn) out += '\n', used = 0;
    out.append(kColumn - used, ' ');
    used = kColumn;
  };
  to_second_column();
  const auto append = [&](const std::string& word) {
    if (used > kColumn && used + 1 + word.size() > kWidth) to_second_column();
    if (used > kColumn) out += ' ', ++used;
    out += word;
    used += word.size();
  };
  std::istringstream words(text);
  for (std::string word; words >> word;) append(word);
  if (!last.empty()) append(last);
  return out + '\n';
}

std::string placeholder(const CLI::Option& option) {
  return option.get_type_size() == 0 || option.get_type_name().empty() ? "" : " " + option.get_type_name();
}

std::string default_text(const CLI::Option& option) {
  if (option.get_required() && option.nonpositional()) return "(required)";
  const bool stated = option.get_type_size() != 0 && !option.get_default_str().empty();
  return stated ? "(default " + option.get_default_str() + ")" : "";
}

}  // namespace

HelpFormatter::HelpFormatter() {
  label("Positionals", "Arguments");
  column_width(kColumn);
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::string text =
      make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) + make_subcommands(app, mode);
  for (const std::string& group : app->get_groups()) {
    const auto options = app->get_options(
        [&](const CLI::Option* option) { return option->get_group() == group && option->nonpositional(); });
    if (!options.empty()) text += make_group(group, false, options);
  }
  return text + "\n" + make_footer(app);
}

std::string HelpFormatter::make_usage(const CLI::App* app, std::string name) const {
  std::string arguments;
  for (const CLI::Option* option : app->get_options())
    if (option->get_positional())
      arguments += " " + option->get_name(true);
    else if (option->get_required())
      arguments += " " + option->get_name() + placeholder(*option);
  const bool has_commands = !app->get_subcommands([](const CLI::App*) { return true; }).empty();
  return "\nUsage: " + (name.empty() ? app->get_name() : name) + (has_commands ? " COMMAND" : arguments) +
         " [OPTIONS]\n";
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  const std::string name = is_positional ? option->get_name(true) : option->get_name(false, true);
  return two_columns("  " + name + placeholder(*option), option->get_description(), default_text(*option));
}

}  // namespace alhazen
