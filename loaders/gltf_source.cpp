#include "loaders/gltf_source.h"

#include <algorithm>
#include <exception>

#include "core/error.h"
#include "loaders/gltf_extensions.h"
#include "loaders/gltf_schema.h"

namespace alhazen {
namespace {

using nlohmann::json;

/// What the file names, each once. A required one that is not known is an error, or ignored; of one that is known and
/// ignored, what it brings is left out of the picture, with a warning.
std::vector<Extension> read_extensions(const JsonRef& root, bool ignore_required, Warnings& warn) {
  std::vector<Extension> all;
  const auto add = [&](const std::string& name, bool required) {
    const auto known = std::find_if(all.begin(), all.end(), [&](const Extension& e) { return e.name == name; });
    if (known == all.end()) all.push_back(treat_extension(name, required));
  };
  std::vector<JsonRef> required = root.elements("extensionsRequired");
  for (const JsonRef& r : root.elements("extensionsUsed")) {
    const auto same = [&](const JsonRef& other) { return other.value() == r.value(); };
    add(r.as<std::string>(), std::any_of(required.begin(), required.end(), same));
  }
  for (const JsonRef& r : required) {
    const auto name = r.as<std::string>();
    if (!is_known(name) && !ignore_required)
      r.fail("requires the extension " + name + ", which is not supported; --ignore-required renders what is left");
    add(name, true);
  }
  std::string ignored;
  for (const Extension& e : all) {
    if (e.treatment != Treatment::ignored) continue;
    if (e.required)
      warn("/extensionsRequired", "requires " + e.name + ", which is ignored: " + e.meaning);
    else
      ignored += (ignored.empty() ? "" : ", ") + e.name;
  }
  if (!ignored.empty()) warn("/extensionsUsed", "ignored: " + ignored);
  return all;
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

/// What the elements of a file's arrays take besides their JSON: tinygltf's and ours, found out by measuring.
void take_elements(const JsonRef& root, LoadBudget& budget) {
  constexpr std::pair<const char*, uint64_t> kBytes[] = {
      {"nodes", 1000}, {"materials", 3600}, {"textures", 400}, {"samplers", 400},    {"scenes", 400}, {"images", 200},
      {"meshes", 500}, {"accessors", 600},  {"cameras", 1200}, {"bufferViews", 500}, {"buffers", 100}};
  for (const auto& [key, bytes] : kBytes)
    if (root.has(key)) budget.take(root[key], root[key].value().size(), bytes);
  constexpr uint64_t kPrimitive = 1000;
  for (const JsonRef& mesh : root.elements("meshes"))
    budget.take(mesh["primitives"], mesh["primitives"].value().size(), kPrimitive);
}

}  // namespace

void Warnings::operator()(const std::string& pointer, const std::string& text) {
  constexpr size_t kMost = 1000;
  if (!sink_ || given_.size() > kMost || !given_.insert(pointer + text).second) return;
  if (given_.size() > kMost)
    sink_(file_ + ": there are more warnings, which are left out");
  else
    sink_(file_ + ": " + (pointer.empty() ? "" : pointer + ": ") + text);
}

GltfSource check_gltf_source(GltfDocument document, const WarningSink& sink, std::shared_ptr<LoadBudget> budget) {
  Warnings warn(document.json.file, sink);
  const JsonRef root(document.json);
  budget->progress.begin("checking");
  check_gltf(root);
  take_elements(root, *budget);
  std::vector<Extension> extensions = read_extensions(root, budget->limits().ignore_required, warn);
  tinygltf::Model model = parse_core(document.json);
  return {std::move(document), std::move(model), std::move(extensions), std::move(warn), std::move(budget)};
}

GltfSource read_gltf_source(const std::filesystem::path& path, const WarningSink& sink,
                            std::shared_ptr<LoadBudget> budget) {
  GltfDocument document = read_gltf_document(path, *budget);
  return check_gltf_source(std::move(document), sink, std::move(budget));
}

}  // namespace alhazen
