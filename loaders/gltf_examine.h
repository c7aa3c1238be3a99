// What the specification forbids and a picture can do without: found for those who ask what a file holds.
#pragma once

#include <filesystem>
#include <memory>

#include "loaders/gltf.h"

namespace alhazen {

/// Goes through a file that loads and warns of what breaks the specification, though it is let through: bounds of
/// accessors that are missing or wrong, extensions that are not declared, empty lists, wrong references in what is not
/// used, and such. Reads the file once more, all of its accessors, and the heads of its images. Throws as `load_gltf`.
void examine_gltf(const std::filesystem::path& file, const WarningSink& warn,
                  const std::shared_ptr<LoadBudget>& budget);

}  // namespace alhazen
