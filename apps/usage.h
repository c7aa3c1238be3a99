// Command lines that ask for what there is not, answered in sentences.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "apps/suggestion.h"
#include "core/error.h"

namespace alhazen {

/// What a parse error of `program` means, naming the nearest command or option where one is unknown.
[[nodiscard]] UsageError usage_error(const CLI::App& program, const CLI::ParseError& error);

/// An option whose value is one of a few words. `value` holds the default.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& name, T& value,
                        const std::vector<std::pair<std::string, T>>& choices, const std::string& description) {
  std::vector<std::string> words;
  std::string default_word;
  for (const auto& [word, meaning] : choices) {
    words.push_back(word);
    if (meaning == value) default_word = word;
  }
  const auto choose = [&value, choices, words, name](const std::string& text) {
    for (const auto& [word, meaning] : choices)
      if (word == text) return void(value = meaning);
    throw CLI::ValidationError(name,
                               "unknown '" + text + "', expected one of " + joined(words) + did_you_mean(text, words));
  };
  return command.add_option_function<std::string>(name, choose, description)
      ->type_name(joined(words, "|"))
      ->default_str(default_word);
}

}  // namespace alhazen
