#include "apps/crosscheck_target.h"

#include <algorithm>
#include <cstdio>

#include "apps/pick_camera.h"
#include "apps/suggestion.h"
#include "core/error.h"
#include "crosscheck/report.h"
#include "crosscheck/scene_subjects.h"
#include "renderer/camera_ray.h"

namespace alhazen {
namespace {

using namespace crosscheck;

constexpr const char* kWholeScene = "scene";                   // the --shape of camera rays
constexpr const char *kMeshes = "mesh", *kSpawning = "spawn";  // the --shape of what is judged as a whole
constexpr size_t kMostNamesListed = 30;

std::vector<Family> families_named(const std::vector<Family>& families, const std::string& name) {
  if (name == "all") return families;
  std::vector<Family> found;
  for (const Family& family : families)
    if (family.name == name) found.push_back(family);
  return found;
}

std::vector<std::string> names_of(const std::vector<Family>& families) {
  std::vector<std::string> names;
  for (const Family& family : families) names.push_back(family.name);
  return names;
}

[[noreturn]] void refuse_shape(const std::string& name, std::vector<std::string> known) {
  const std::string nearest = did_you_mean(name, known);
  const bool many = known.size() > kMostNamesListed;
  if (many) known.resize(kMostNamesListed), known.emplace_back("...");
  throw UsageError("--shape: unknown '" + name + "', expected all or one of " + joined(known) + nearest);
}

/// `camera`: whether there are camera rays, which are no family's.
std::vector<Population> populations_named(const std::string& name, bool camera) {
  std::vector<Population> all;
  std::vector<std::string> names;
  for (int k = 0; k < kPopulations; ++k) {
    const auto population = Population(k);
    if (population == Population::camera && !camera) continue;
    names.emplace_back(name_of(population));
    if (population != Population::camera) all.push_back(population);
    if (name == names.back())
      return population == Population::camera ? std::vector<Population>{} : std::vector{population};
  }
  if (name == "all") return all;
  throw UsageError("--population: unknown '" + name + "', expected all or one of " + joined(names) +
                   did_you_mean(name, names));
}

CrosscheckTarget plugin_target(const CrosscheckArguments& arguments) {
  CrosscheckTarget target;
  target.source = " --intersector " + shell_word(arguments.intersector);
  target.plugin = std::make_unique<Plugin>(arguments.intersector);
  const Family family = family_of(target.plugin->intersector());
  target.families = families_named({family}, arguments.shape);
  if (target.families.empty()) refuse_shape(arguments.shape, {family.name});
  target.populations = populations_named(arguments.population, false);
  return target;
}

CrosscheckTarget built_in_target(const CrosscheckArguments& arguments) {
  CrosscheckTarget target;
  target.families = families_named(built_in_families(), arguments.shape);
  target.populations = populations_named(arguments.population, false);
  const bool whole = arguments.population == "all" && !arguments.options.only, all = arguments.shape == "all";
  target.meshes = whole && (all || arguments.shape == kMeshes);
  target.spawning = whole && (all || arguments.shape == kSpawning);
  if (!target.families.empty() || target.meshes || target.spawning) return target;
  std::vector<std::string> names = names_of(built_in_families());
  if (whole) names.insert(names.end(), {kMeshes, kSpawning});
  refuse_shape(arguments.shape, names);
}

void add_picture(const CrosscheckArguments& arguments, CrosscheckTarget& target) {
  const int width = arguments.picture.width, height = arguments.picture.height;
  if (arguments.options.only && *arguments.options.only >= uint64_t(width) * uint64_t(height))
    throw UsageError("--only: the picture has no ray " + std::to_string(*arguments.options.only) + ", its " +
                     std::to_string(width) + " x " + std::to_string(height) + " are numbered y " +
                     std::to_string(width) + " + x");
  const Camera camera = pick_camera(*target.scene, arguments.camera, double(width) / height);
  target.view = {width, height,
                 [camera, width, height](int x, int y) { return camera_ray(camera, width, height, x + 0.5, y + 0.5); }};
  target.view_options = " --size " + std::to_string(width) + "x" + std::to_string(height);
  if (!arguments.camera.empty()) target.view_options += " --camera " + shell_word(arguments.camera);
  target.picture = std::make_unique<SceneCheck>(target.scene->geometry, target.scene->node_names);
}

CrosscheckTarget scene_target(const CrosscheckArguments& arguments) {
  CrosscheckTarget target;
  target.source = " " + shell_word(arguments.scene);
  if (!arguments.choice.scene.empty()) target.source += " --scene " + shell_word(arguments.choice.scene);
  const auto warn = [](const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); };
  target.scene = std::make_unique<Scene>(
      load_gltf(arguments.scene, warn, arguments.choice, std::make_shared<LoadBudget>(arguments.limits)).scene);
  const auto& materials = target.scene->materials;
  const auto is_cut = [](const Material& m) { return m.alpha_mode == AlphaMode::mask; };
  if (const auto cut = std::count_if(materials.begin(), materials.end(), is_cut))
    warn(arguments.scene + ": " + std::to_string(cut) +
         " of its materials cut holes (alphaMode MASK): rays are judged as if there were none");
  Geometry& geometry = target.scene->geometry;
  bake_single_instances(geometry);
  target.populations = populations_named(arguments.population, true);
  const bool only_camera = arguments.population == name_of(Population::camera), whole = arguments.shape == kWholeScene;
  if (!whole) target.families = scene_families(geometry, target.scene->node_names, arguments.shape);
  const bool unknown = !whole && arguments.shape != "all" && target.families.empty();
  if (unknown || (only_camera && !whole && arguments.shape != "all")) {
    std::vector<std::string> known{kWholeScene};
    if (!only_camera)
      for (std::string& name : scene_family_names(geometry, target.scene->node_names)) known.push_back(std::move(name));
    refuse_shape(arguments.shape, known);
  }
  if (only_camera) target.families.clear();
  const bool camera = only_camera || arguments.population == "all";
  if (whole && !camera) throw UsageError("--shape scene: has camera rays alone, --population camera or all");
  if (camera && (whole || arguments.shape == "all")) add_picture(arguments, target);
  return target;
}

}  // namespace

CrosscheckTarget crosscheck_target(const CrosscheckArguments& arguments) {
  if (!arguments.scene.empty() && !arguments.intersector.empty())
    throw UsageError("--intersector: is checked by itself, not in a scene");
  if (!arguments.intersector.empty()) return plugin_target(arguments);
  return arguments.scene.empty() ? built_in_target(arguments) : scene_target(arguments);
}

}  // namespace alhazen
