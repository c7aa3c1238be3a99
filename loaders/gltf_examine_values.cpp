// What may be wrong anywhere in a file: lists without elements, extensions.
#include <algorithm>
#include <set>
#include <string_view>

#include "loaders/gltf_examiner.h"
#include "loaders/gltf_extensions.h"

namespace alhazen {
namespace {

using nlohmann::json;

/// What an object at a JSON pointer is: "nodes" for one of the nodes, "texture" for a use of a texture, else its key.
std::string_view kind_at(std::string_view pointer) {
  const auto last = [&] { return pointer.substr(pointer.rfind('/') + 1); };
  if (pointer.empty()) return "root";
  if (last().find_first_not_of("0123456789") == std::string_view::npos) pointer.remove_suffix(last().size() + 1);
  return last().ends_with("Texture") ? "texture" : last();
}

/// Whether an extension has a meaning there; of what is not listed, everywhere.
bool has_meaning_at(std::string_view extension, std::string_view kind) {
  constexpr std::pair<std::string_view, std::string_view> kPlaces[] = {
      {"KHR_materials_variants", "root primitives"},
      {"KHR_materials_", "materials"},
      {"KHR_lights_punctual", "root nodes"},
      {"EXT_lights_image_based", "root scenes"},
      {"KHR_texture_transform", "texture"},
      {"KHR_texture_basisu", "textures"},
      {"EXT_texture_webp", "textures"},
      {"MSFT_texture_dds", "textures"},
      {"EXT_mesh_gpu_instancing", "nodes"},
      {"KHR_node_visibility", "nodes"},
      {"MSFT_lod", "nodes materials"},
      {"KHR_draco_mesh_compression", "primitives"},
      {"FB_ngon_encoding", "primitives"},
      {"EXT_meshopt_compression", "buffers bufferViews"},
      {"KHR_meshopt_compression", "buffers bufferViews"},
      {"KHR_animation_pointer", "target"}};
  const auto place = std::find_if(std::begin(kPlaces), std::end(kPlaces),
                                  [&](const auto& p) { return extension.starts_with(p.first); });
  return place == std::end(kPlaces) ||
         (" " + std::string(place->second) + " ").find(" " + std::string(kind) + " ") != std::string::npos;
}

void examine_value(Examiner& e, const JsonRef& r);

void examine_extension(Examiner& e, const JsonRef& r, const std::string& name, std::string_view kind) {
  e.unless(e.used.contains(name), r, "is not declared in extensionsUsed");
  e.unless(has_meaning_at(name, kind), r, "has no meaning here");
  if (treat_extension(name, false).treatment != Treatment::ignored) examine_value(e, r);
}

/// Lists without elements; extensions that are not declared, or stand where they have no meaning. JSON nests 64 deep at
/// most.
void examine_value(Examiner& e, const JsonRef& r) {
  const json& value = r.value();
  if (value.is_array()) {
    e.unless(!value.empty(), r, "is empty, expected one element or more");
    for (size_t i = 0; i < value.size() && value[i].is_structured(); ++i) examine_value(e, r[i]);
  }
  if (!value.is_object()) return;
  for (const auto& item : value.items()) {
    if (item.key() == "extras" || !item.value().is_structured()) continue;
    if (item.key() != "extensions") {
      examine_value(e, r[item.key()]);
      continue;
    }
    for (const auto& extension : item.value().items())
      examine_extension(e, r["extensions"][extension.key()], extension.key(), kind_at(r.pointer()));
  }
}

void examine_names(Examiner& e) {
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    std::set<std::string> seen;
    for (const JsonRef& r : e.root().elements(key))
      e.unless(seen.insert(r.as<std::string>()).second, r, "is listed twice");
  }
  for (const JsonRef& r : e.root().elements("extensionsRequired"))
    e.unless(e.used.contains(r.as<std::string>()), r, "is required, but not listed in extensionsUsed");
  const auto required = e.root().get("extensionsRequired", std::set<std::string>{});
  e.unless(!e.used.contains("KHR_mesh_quantization") || required.contains("KHR_mesh_quantization"), e.root(),
           "KHR_mesh_quantization is used, but not listed in extensionsRequired");
}

}  // namespace

void examine_values(Examiner& e) {
  examine_value(e, e.root());
  examine_names(e);
}

}  // namespace alhazen
