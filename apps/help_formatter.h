// How --help looks.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace alhazen {

/// Names and placeholders on the left, sentences on the right, wrapped, each with its default.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_description(const CLI::App* app) const override { return app->get_description() + "\n"; }
};

}  // namespace alhazen
