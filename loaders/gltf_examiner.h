// How the examiners of a glTF file's parts say what they find.
#pragma once

#include <set>
#include <string>
#include <utility>

#include "loaders/gltf_accessor.h"
#include "loaders/gltf_source.h"
#include "loaders/json_check.h"

namespace alhazen {

struct Examiner {
  GltfSource& source;
  const GltfBuffers& buffers;
  LoadBudget& files;                                   // for what is looked at and not kept
  std::set<std::string> used;                          // extensions that are declared
  std::set<std::pair<std::string, size_t>> seen = {};  // what was examined of which accessor or material

  /// Whether this is the first time; many may share one, and none is gone through again.
  bool first(const std::string& what, size_t index) { return seen.insert({what, index}).second; }

  [[nodiscard]] JsonRef root() const { return source.root(); }
  void say(const JsonRef& r, const std::string& text) const { source.warn(r.pointer(), text); }
  void unless(bool good, const JsonRef& r, const std::string& text) const {
    if (!good) say(r, text);
  }
  /// What `check` would refuse is but mentioned. Whether it would not.
  bool unless(const Check& check, const JsonRef& r) const;
};

/// Lists without elements, and extensions: their names and where they stand.
void examine_values(Examiner& e);
void examine_meshes(Examiner& e);
/// Skins and animations.
void examine_motion(Examiner& e);

}  // namespace alhazen
