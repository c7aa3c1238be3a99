#include "apps/limit_options.h"

#include <cmath>
#include <cstdlib>
#include <string>

namespace alhazen {
namespace {

/// "512M" to 2^29; K, M, G and T stand for powers of 1024.
uint64_t parse_amount(const std::string& option, const std::string& text) {
  constexpr const char* kUnits = "KMGT";
  constexpr double kMost = 9007199254740992.0;  // 2^53
  char* end = nullptr;
  double amount = std::strtod(text.c_str(), &end);
  for (const char* unit = kUnits; *unit; ++unit)
    if (*end == *unit || *end == *unit + ('a' - 'A')) {
      amount = std::ldexp(amount, 10 * int(unit - kUnits + 1));
      ++end;
      break;
    }
  if (end == text.c_str() || *end != '\0' || !(amount >= 1 && amount <= kMost))
    throw CLI::ValidationError(option, "'" + text + "' is not a number of 1 or more, like 4096, 512M or 1.5G");
  return uint64_t(amount);
}

CLI::Option* add_amount(CLI::App& command, const std::string& name, uint64_t& value, const std::string& description) {
  return command.add_option_function<std::string>(
      name, [&value, name](const std::string& text) { value = parse_amount(name, text); }, description);
}

}  // namespace

void add_limit_options(CLI::App& command, LoadLimits& limits) {
  add_amount(command, "--max-memory", limits.memory,
             "Memory that the scene may take, estimated before it is taken; by default 192M and 128 times the size of "
             "its files, and at most 3/4 of the machine's")
      ->type_name("SIZE");
  add_amount(command, "--max-image-pixels", limits.image_pixels, "Pixels that one image may have")
      ->type_name("N")
      ->default_str("256M");
  add_amount(command, "--max-node-depth", limits.node_depth, "How deep nodes may be nested")
      ->type_name("N")
      ->default_str("4096");
  add_amount(command, "--max-json", limits.json, "Size that the JSON may have")->type_name("SIZE")->default_str("256M");
  command.add_flag("--ignore-required", limits.ignore_required,
                   "Take files that require extensions which are not known here, and leave these out");
}

}  // namespace alhazen
