// A glTF file read and checked: what the readers of its parts look at. The core comes from tinygltf's model, extensions
// from the JSON (tinygltf keeps their integers in 32 bits).
#pragma once

#include <tiny_gltf.h>

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "loaders/gltf.h"
#include "loaders/gltf_document.h"

namespace alhazen {

/// Passes warnings on, each text once, a thousand at most.
class Warnings {
 public:
  Warnings(std::string file, WarningSink sink) : file_(std::move(file)), sink_(std::move(sink)) {}
  /// At a JSON pointer, which may be empty.
  void operator()(const std::string& pointer, const std::string& text);

 private:
  std::string file_;
  WarningSink sink_;
  std::set<std::string> given_;
};

struct GltfSource {
  GltfDocument document;
  tinygltf::Model model;  // as many elements of each kind as the JSON has; buffers and images are placeholders
  std::vector<Extension> extensions;  // of `extensionsUsed` and `extensionsRequired`
  Warnings warn;
  std::shared_ptr<LoadBudget> budget;

  [[nodiscard]] JsonRef root() const { return JsonRef(document.json); }
  /// Element `i` of the root's array `key`.
  [[nodiscard]] JsonRef at(const char* key, size_t i) const { return root()[key][i]; }
};

/// Reads and checks the file, all but the bytes of buffers and images. Throws LoadError for whatever `check_gltf`
/// finds. Extensions that are ignored give a warning.
[[nodiscard]] GltfSource read_gltf_source(const std::filesystem::path& path, const WarningSink& warn,
                                          std::shared_ptr<LoadBudget> budget = std::make_shared<LoadBudget>());

/// The same of a document.
[[nodiscard]] GltfSource check_gltf_source(GltfDocument document, const WarningSink& warn,
                                           std::shared_ptr<LoadBudget> budget);

/// Accessors that have no bufferView get this one in the model: all zeros.
[[nodiscard]] inline int zeros_view(const tinygltf::Model& model) { return int(model.bufferViews.size()) - 1; }

}  // namespace alhazen
