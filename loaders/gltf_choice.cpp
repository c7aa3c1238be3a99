#include "loaders/gltf_choice.h"

#include <numeric>

#include "core/error.h"

namespace alhazen {
namespace {

/// By name first: a name may look like an index.
size_t find(const std::string& option, const std::string& what, const std::string& wanted,
            const std::vector<JsonRef>& all) {
  std::string known;
  for (size_t i = 0; i < all.size(); ++i) {
    const auto name = all[i].get("name", std::string{});
    if (name == wanted) return i;
    known += (known.empty() ? "" : ", ") + std::to_string(i) + (name.empty() ? "" : " '" + name + "'");
  }
  for (size_t i = 0; i < all.size(); ++i)
    if (std::to_string(i) == wanted) return i;
  throw UsageError(option + ": there is no " + what + " '" + wanted + "'; the file has " +
                   (known.empty() ? "none" : known));
}

}  // namespace

std::optional<size_t> choose_scene(const GltfSource& source, const std::string& wanted) {
  const auto scenes = source.root().elements("scenes");
  if (!wanted.empty()) return find("--scene", "scene", wanted, scenes);
  if (scenes.empty()) return std::nullopt;
  return source.root().get("scene", size_t{0});
}

std::optional<size_t> choose_variant(const GltfSource& source, const std::string& wanted) {
  if (wanted.empty()) return std::nullopt;
  const auto e = source.root().extension("KHR_materials_variants");
  return find("--variant", "variant", wanted, e ? e->elements("variants") : std::vector<JsonRef>{});
}

std::vector<size_t> choose_animations(const GltfSource& source, const std::string& wanted) {
  const auto animations = source.root().elements("animations");
  if (wanted == "none" || (wanted.empty() && animations.empty())) return {};
  if (wanted.empty()) return {0};
  if (wanted != "all") return {find("--animation", "animation", wanted, animations)};
  std::vector<size_t> all(animations.size());
  std::iota(all.begin(), all.end(), size_t{0});
  return all;
}

}  // namespace alhazen
