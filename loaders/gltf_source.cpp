#include "loaders/gltf_source.h"

#include <algorithm>
#include <array>
#include <exception>
#include <string_view>

#include "core/error.h"
#include "loaders/gltf_schema.h"

namespace alhazen {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 11> kSupported{"KHR_lights_punctual",
                                                      "KHR_texture_transform",
                                                      "KHR_materials_unlit",
                                                      "KHR_materials_emissive_strength",
                                                      "KHR_materials_ior",
                                                      "KHR_materials_specular",
                                                      "KHR_materials_transmission",
                                                      "ALHAZEN_materials_phong",
                                                      "ALHAZEN_lights",
                                                      "ALHAZEN_shapes",
                                                      "FB_ngon_encoding"};

bool is_supported(const std::string& name) {
  return std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

/// What `extensionsUsed` names.
std::vector<Extension> read_extensions(const JsonRef& root, Warnings& warn) {
  std::set<std::string> all_required;
  for (const JsonRef& r : root.elements("extensionsRequired")) {
    const auto name = r.as<std::string>();
    if (!is_supported(name)) r.fail("requires the extension " + name + ", which is not supported");
    all_required.insert(name);
  }
  std::vector<Extension> used;
  std::string ignored;
  for (const JsonRef& r : root.elements("extensionsUsed")) {
    const auto name = r.as<std::string>();
    used.push_back({name, all_required.contains(name), is_supported(name)});
    if (!is_supported(name)) ignored += (ignored.empty() ? "" : ", ") + name;
  }
  if (!ignored.empty()) warn("/extensionsUsed", "ignored: " + ignored);
  return used;
}

/// Takes away what tinygltf would copy without need.
void strip(json& value) {
  if (value.is_object()) {
    value.erase("extensions");
    value.erase("extras");
  }
  if (value.is_structured())
    for (json& element : value) strip(element);
}

/// The core of a checked file in which tinygltf has no byte to decode, no file to open and nothing to refuse.
json core_without_bytes(const json& root) {
  json core = {{"asset", {{"version", root["asset"]["version"]}}}};
  for (const char* key : {"bufferViews", "accessors", "samplers", "textures", "materials", "meshes", "cameras", "nodes",
                          "scenes", "scene"})
    if (root.contains(key)) core[key] = root[key];
  strip(core);
  core["buffers"] = json::array({{{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}}});
  json& views = core["bufferViews"];
  views.push_back({{"buffer", 0}, {"byteLength", 1}});  // see zeros_view
  if (core.contains("accessors"))
    for (json& accessor : core["accessors"])
      if (!accessor.contains("bufferView")) accessor["bufferView"] = views.size() - 1;
  return core;
}

tinygltf::Model parse_core(const JsonDocument& document) {
  tinygltf::Model model;
  std::string error, warning;
  bool parsed = false;
  try {
    const std::string text = core_without_bytes(document.root).dump(-1, ' ', false, json::error_handler_t::replace);
    tinygltf::TinyGLTF parser;
    parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(), unsigned(text.size()), "");
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  const auto complete = [&](const char* key, size_t parsed_elements) {
    return !document.root.contains(key) || document.root[key].size() == parsed_elements;
  };
  const bool all = complete("accessors", model.accessors.size()) && complete("samplers", model.samplers.size()) &&
                   complete("textures", model.textures.size()) && complete("materials", model.materials.size()) &&
                   complete("meshes", model.meshes.size()) && complete("cameras", model.cameras.size()) &&
                   complete("nodes", model.nodes.size()) && complete("scenes", model.scenes.size());
  if (!parsed || !all) throw LoadError(document.file, "", "cannot be parsed: " + error);
  return model;
}

}  // namespace

void Warnings::operator()(const std::string& pointer, const std::string& text) {
  if (sink_ && given_.insert(pointer + text).second)
    sink_(file_ + ": " + (pointer.empty() ? "" : pointer + ": ") + text);
}

GltfSource read_gltf_source(const std::filesystem::path& path, const WarningSink& sink) {
  GltfDocument document = read_gltf_document(path);
  Warnings warn(document.json.file, sink);
  const JsonRef root(document.json);
  check_gltf(root);
  std::vector<Extension> extensions = read_extensions(root, warn);
  tinygltf::Model model = parse_core(document.json);
  return {std::move(document), std::move(model), std::move(extensions), std::move(warn)};
}

}  // namespace alhazen
