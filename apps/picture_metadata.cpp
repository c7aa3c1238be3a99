#include "apps/picture_metadata.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>

#include "accel/accelerated_scene.h"

namespace alhazen {
namespace {

/// Seconds since 1970 by the convention of reproducible-builds.org.
std::optional<std::time_t> source_date() {
  const char* text = std::getenv("SOURCE_DATE_EPOCH");
  if (!text || !*text) return std::nullopt;
  char* end = nullptr;
  const long long seconds = std::strtoll(text, &end, 10);
  return *end == 0 && seconds >= 0 ? std::optional(std::time_t(seconds)) : std::nullopt;
}

/// As EXIF and EXR write it, in universal time.
std::string date_text(std::time_t seconds) {
  std::tm utc = {};
  gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &utc);
  return text;
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", seconds);
  return text;
}

}  // namespace

Metadata picture_metadata(const RenderArguments& arguments, const RenderControl& control, bool complete,
                          double render_seconds) {
  const std::string options = picture_options(arguments);
  const auto fixed_date = source_date();
  Metadata metadata = {
      {"Software", "Alhazen " ALHAZEN_VERSION},
      {"DateTime", date_text(fixed_date.value_or(std::time(nullptr)))},
      {"ImageDescription", "alhazen render '" + arguments.scene + "' " + options + (complete ? "" : " (partial)")},
      {"alhazen:scene", arguments.scene},
      {"alhazen:options", options},
      {"alhazen:samples", std::to_string(arguments.options.samples)},
      {"alhazen:traversal", traversal_version()}};
  if (!fixed_date) metadata.emplace_back("alhazen:renderSeconds", seconds_text(render_seconds));
  if (!complete)
    metadata.emplace_back("alhazen:partial",
                          std::to_string(control.pixels_done) + " of " +
                              std::to_string(uint64_t(arguments.options.width) * uint64_t(arguments.options.height)) +
                              " pixels");
  return metadata;
}

}  // namespace alhazen
