// What `alhazen brdf` is asked about.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/vec.h"
#include "loaders/load_limits.h"
#include "reflectance/models.h"

namespace alhazen {

/// A number from `least` to `most`, both included; "not a number" is none.
[[nodiscard]] CLI::Validator within(double least, double most);

/// A scene's material, a measured surface, or a model by name.
struct SubjectArguments {
  std::string file;      // a scene, or a measured surface (.binary, .csv); empty: a model
  std::string material;  // name or index
  Vec2f uv{0.5f, 0.5f};
  LoadLimits limits;
  std::string model;  // empty: a material
  ModelSettings settings;
  std::vector<std::string> given;  // names of the settings that the command line gives
};

/// Fills `arguments`, which must live as long as `command`, when the command line is parsed.
void add_subject_options(CLI::App& command, SubjectArguments& arguments);

/// Throws UsageError for what there is not, naming what there is; LoadError for a file that cannot be read.
[[nodiscard]] Subject subject_of(const SubjectArguments& arguments);

}  // namespace alhazen
