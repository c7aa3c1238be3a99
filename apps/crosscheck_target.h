// What `alhazen crosscheck` puts to the test: built-in shapes, an intersector of the user's, or a scene.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "crosscheck/plugin.h"
#include "crosscheck/scene_check.h"
#include "loaders/gltf.h"
#include "renderer/render.h"

namespace alhazen {

struct CrosscheckArguments {
  std::string scene;  // a file
  SceneChoice choice;
  LoadLimits limits;
  std::string shape = "all", population = "all", camera, json, map, intersector;
  std::vector<std::string> cases;  // files
  bool shrink = false;             // B's errors, too
  crosscheck::Options options;
  RenderOptions picture;  // its size alone
  int threads = 0;
  double t_ulp = 1, rays = 1e5;
};

struct CrosscheckTarget {
  std::string source;  // the arguments that name it, with a space in front
  std::vector<crosscheck::Family> families;
  std::vector<crosscheck::Population> populations;  // of the families
  bool meshes = false, spawning = false;            // of the built-in checks, those of no family
  std::unique_ptr<crosscheck::Plugin> plugin;
  std::unique_ptr<Scene> scene;
  std::unique_ptr<crosscheck::SceneCheck> picture;  // where camera rays are wanted
  crosscheck::View view;
  std::string view_options;  // that name the view, with a space in front
};

/// Throws UsageError for names that there are not, LoadError for a bad scene or library.
[[nodiscard]] CrosscheckTarget crosscheck_target(const CrosscheckArguments& arguments);

}  // namespace alhazen
