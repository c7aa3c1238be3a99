// What is looked at: a BRDF with its name and where it comes from.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/vec.h"
#include "materials/brdf.h"

namespace alhazen {

/// The shares of a ray that go on as single rays. They have no value in 1/sr: their lobes have no width.
struct RayShares {
  Rgb mirrored, transmitted;
};

/// Of a ray that meets the surface from outside under an angle of that cosine.
using SmoothPart = std::function<RayShares(float cos_theta)>;

struct Subject {
  std::string name;                                           // "copper"
  std::string model;                                          // "glTF metallic-roughness"
  std::vector<std::pair<std::string, std::string>> settings;  // what the model was given: {"roughness", "0.22"}
  Brdf brdf;
  SmoothPart smooth;               // empty: none
  std::vector<std::string> notes;  // sentences: what is not shown, how units are read
};

}  // namespace alhazen
