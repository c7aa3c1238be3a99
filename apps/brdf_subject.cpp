#include "apps/brdf_subject.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/prepare_scene.h"
#include "apps/suggestion.h"
#include "core/error.h"
#include "inspect/tree_words.h"
#include "loaders/gltf.h"
#include "loaders/image_decode.h"
#include "loaders/measured_file.h"
#include "reflectance/material_brdf.h"

namespace alhazen {
namespace {

/// Whether all of the text is so many finite numbers between commas.
bool parse_numbers(const std::string& text, size_t count, float* values) {
  const char* at = text.c_str();
  for (size_t i = 0; i < count; ++i) {
    char* end = nullptr;
    values[i] = std::strtof(at, &end);
    if (end == at || !std::isfinite(values[i]) || *end != (i + 1 < count ? ',' : '\0')) return false;
    at = end + 1;
  }
  return true;
}

Rgb parse_reflectance(const std::string& option, const std::string& text) {
  float v[3] = {-1, -1, -1};
  if (parse_numbers(text, 1, v))
    v[1] = v[2] = v[0];
  else if (!parse_numbers(text, 3, v))
    v[0] = -1;
  if (std::min(v[0], std::min(v[1], v[2])) < 0)
    throw CLI::ValidationError(option, "'" + text + "' is not one number >= 0, nor R,G,B, like 0.8 or 0.9,0.6,0.4");
  return {v[0], v[1], v[2]};
}

void add_settings(CLI::App& command, SubjectArguments& arguments) {
  ModelSettings& settings = arguments.settings;
  const auto add_reflectance = [&](const char* name, Rgb& value, const std::string& description) {
    command
        .add_option_function<std::string>(
            "--" + std::string(name),
            [&arguments, &value, name](const std::string& text) {
              value = parse_reflectance("--" + std::string(name), text), arguments.given.push_back(name);
            },
            description)
        ->type_name("X|R,G,B");
  };
  const auto add_number = [&](const char* name, float& value, double least, double most,
                              const std::string& description) {
    command
        .add_option_function<double>(
            "--" + std::string(name),
            [&arguments, &value, name](double v) { value = float(v), arguments.given.push_back(name); }, description)
        ->type_name("X")
        ->check(within(least, most));
  };
  add_reflectance("diffuse", settings.diffuse, "Diffuse albedo, or base color (default 0.5)");
  add_reflectance("specular", settings.specular, "Of the highlight; of ggx, reflectance at the normal (default 0.3)");
  add_number("shininess", settings.shininess, 0, 1e6, "Phong's exponent (default 32)");
  add_number("roughness", settings.roughness, 0, 1, "As glTF's: alpha is its square (default 0.3)");
  add_number("metallic", settings.metallic, 0, 1, "As glTF's (default 0)");
  add_number("anisotropy", settings.anisotropy, 0, 1, "As glTF's strength, along the tangent (default 0)");
  add_number("ior", settings.ior, 1, 10, "Index of refraction (default 1.5)");
}

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const ReflectanceModel& model : reflectance_models()) names.emplace_back(model.name);
  return names;
}

Subject model_named(const SubjectArguments& arguments) {
  for (const ReflectanceModel& model : reflectance_models()) {
    if (arguments.model != model.name) continue;
    const std::vector<std::string> taken(model.settings.begin(), model.settings.end());
    for (const std::string& given : arguments.given)
      if (std::ranges::find(taken, given) == taken.end())
        throw UsageError("--" + given + ": " + arguments.model + " does not take it; it takes --" +
                         joined(taken, ", --"));
    return model.subject(arguments.settings);
  }
  throw UsageError("--model: unknown '" + arguments.model + "', expected one of " + joined(model_names()) +
                   did_you_mean(arguments.model, model_names()));
}

/// Of the file's materials; the one that stands for none is not asked for by name.
uint32_t pick_material(const Scene& scene, const std::string& wanted) {
  const auto count = uint32_t(scene.materials.size() - 1);
  if (wanted.empty() && count == 1) return 0;
  std::vector<std::string> names, descriptions;
  for (uint32_t i = 0; i < count; ++i) {
    const std::string& name = scene.materials[i].name;
    if (!wanted.empty() && name == wanted) return i;
    if (!name.empty()) names.push_back(name);
    descriptions.push_back(std::to_string(i) + (name.empty() ? "" : " '" + name + "'"));
  }
  for (uint32_t i = 0; i < count; ++i)
    if (std::to_string(i) == wanted) return i;
  const std::string there = "the scene has " + (descriptions.empty() ? "none" : joined(descriptions));
  if (wanted.empty()) throw UsageError("--material: which one? " + there);
  throw UsageError("--material: there is no material '" + wanted + "'; " + there + did_you_mean(wanted, names));
}

Subject material_of(const SubjectArguments& arguments) {
  const auto budget = std::make_shared<LoadBudget>(arguments.limits);
  LoadedScene loaded = load_gltf(arguments.file, print_warning, {}, budget);
  const uint32_t material = pick_material(loaded.scene, arguments.material);
  decode_textures(loaded, print_warning);
  return material_subject(loaded.scene, material, arguments.uv);
}

bool is_measured_file(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".binary" || extension == ".csv";
}

Subject measured_of(const SubjectArguments& arguments) {
  if (!arguments.material.empty()) throw UsageError("--material: is one of a scene, not of a measured surface's file");
  LoadBudget budget(arguments.limits);
  return measured_subject(std::make_shared<MeasuredBrdf>(load_measured_brdf(arguments.file, budget)));
}

void parse_uv(const std::string& text, SubjectArguments& arguments) {
  float uv[2];
  if (!parse_numbers(text, 2, uv)) throw CLI::ValidationError("--uv", "'" + text + "' is not U,V, like 0.25,0.75");
  arguments.uv = {uv[0], uv[1]};
}

}  // namespace

CLI::Validator within(double least, double most) {
  return {[=](const std::string& text) {
            char* end = nullptr;
            const double v = std::strtod(text.c_str(), &end);
            const bool valid = end != text.c_str() && *end == 0 && v >= least && v <= most;
            return valid ? ""
                         : "'" + text + "' is not a number from " + short_number(least) + " to " + short_number(most);
          },
          ""};
}

void add_subject_options(CLI::App& command, SubjectArguments& arguments) {
  command
      .add_option("FILE", arguments.file, "A scene (.gltf or .glb), or a measured surface (MERL's .binary, or .csv)")
      ->type_name("");
  command.add_option("--material", arguments.material, "Which of its materials")->type_name("INDEX|NAME");
  command
      .add_option_function<std::string>(
          "--uv", [&arguments](const std::string& text) { parse_uv(text, arguments); },
          "Where its textures are looked up")
      ->type_name("U,V")
      ->default_str("0.5,0.5");
  command.option_defaults()->group("Models, in place of a file");
  command.add_option("--model", arguments.model, "One of " + joined(model_names()))->type_name("NAME");
  add_settings(command, arguments);
}

Subject subject_of(const SubjectArguments& arguments) {
  if (arguments.file.empty() == arguments.model.empty())
    throw UsageError(arguments.file.empty()
                         ? "expected a scene and its --material, a measured surface's file, or a --model"
                         : "--model: takes the place of a file; give one of them");
  if (!arguments.model.empty()) {
    if (!arguments.material.empty()) throw UsageError("--material: is one of a scene, not of a --model");
    return model_named(arguments);
  }
  if (!arguments.given.empty()) throw UsageError("--" + arguments.given.front() + ": is a setting of a --model");
  return is_measured_file(arguments.file) ? measured_of(arguments) : material_of(arguments);
}

}  // namespace alhazen
