#include "apps/info_command.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "apps/limit_options.h"
#include "apps/print.h"
#include "core/error.h"
#include "loaders/gltf_file.h"

namespace alhazen {
namespace {

using Json = nlohmann::ordered_json;

uint64_t triangle_count(const Mesh& mesh) {
  uint64_t count = 0;
  for (const TriangleMesh& part : mesh.parts) count += part.triangles.size();
  return count;
}

/// Without those that are made from others.
size_t image_count(const LoadedScene& loaded) {
  return size_t(std::count_if(loaded.encoded.begin(), loaded.encoded.end(),
                              [](const EncodedImage& image) { return image.glossiness_of == kNone; }));
}

Json counts_json(const LoadedScene& loaded) {
  const Scene& scene = loaded.scene;
  const Geometry& geometry = scene.geometry;
  uint64_t stored = 0, placed = 0;
  for (const Mesh& mesh : geometry.meshes) stored += triangle_count(mesh);
  const std::vector<uint32_t> uses = uses_of_meshes(geometry);
  for (size_t i = 0; i < uses.size(); ++i) placed += uses[i] * triangle_count(geometry.meshes[i]);
  return {{"nodes", scene.node_names.size()},
          {"meshes", geometry.meshes.size()},
          {"mesh_instances", geometry.mesh_instances.size()},
          {"triangles", stored},
          {"triangles_placed", placed},
          {"shapes", geometry.shapes.size()},
          {"shape_instances", geometry.shape_instances.size()},
          {"materials", scene.materials.size() - 1},  // without glTF's default
          {"textures", scene.textures.size()},
          {"images", image_count(loaded)}};
}

Json lights_json(const Scene& scene) {
  constexpr std::array kinds{"directional", "point", "spot"};
  Json lights = Json::array();
  for (const Light& light : scene.lights) lights.push_back({{"name", light.name}, {"kind", kinds[size_t(light.kind)]}});
  return lights;
}

Json cameras_json(const Scene& scene) {
  Json cameras = Json::array();
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[i];
    const bool perspective = camera.kind == Camera::Kind::perspective;
    cameras.push_back({{"index", scene.camera_index[i]},
                       {"name", camera.name},
                       {"kind", perspective ? "perspective" : "orthographic"},
                       {perspective ? "yfov" : "ymag", perspective ? camera.yfov : camera.ymag}});
  }
  return cameras;
}

Json measured_json(const Scene& scene) {
  Json all = Json::array();
  for (const MeasuredBrdf& brdf : scene.measured) {
    const MeasuredGrid& grid = brdf.table.grid;
    all.push_back({{"uri", brdf.name},
                   {"entries", {grid.theta_h, grid.theta_d, grid.phi_d}},
                   {"known", brdf.known},
                   {"roughness", brdf.roughness}});
  }
  return all;
}

Json bounds_json(const Geometry& geometry) {
  const Bounds3d bounds = world_bounds(geometry);
  if (is_empty(bounds)) return nullptr;
  const auto point = [](const Vec3d& p) { return Json{p.x, p.y, p.z}; };
  return {{"min", point(bounds.lower)}, {"max", point(bounds.upper)}};
}

Json extensions_json(const LoadedScene& loaded) {
  constexpr std::array treatments{"supported", "approximated", "ignored"};
  Json extensions = Json::array();
  for (const Extension& extension : loaded.extensions)
    extensions.push_back({{"name", extension.name},
                          {"required", extension.required},
                          {"treatment", treatments[size_t(extension.treatment)]},
                          {"meaning", extension.meaning}});
  return extensions;
}

Json info_json(const std::string& name, const WarningSink& warn, const std::shared_ptr<LoadBudget>& budget) {
  GltfFile file(name, warn, {}, {}, budget);
  const LoadedScene loaded = file.load(0);
  file.examine();
  Json info{{"file", name}};
  info.update(counts_json(loaded));
  info["skins"] = file.skin_count();
  info["animations"] = file.animation_names();
  info["lights"] = lights_json(loaded.scene);
  info["cameras"] = cameras_json(loaded.scene);
  info["measured"] = measured_json(loaded.scene);
  info["bounds"] = bounds_json(loaded.scene.geometry);
  info["extensions"] = extensions_json(loaded);
  return info;
}

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

std::string number(const Json& v) { return v.is_number_float() ? number(v.get<double>()) : v.dump(); }

std::string format_seconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f s", seconds);
  return text;
}

std::string point_text(const Json& p) { return number(p[0]) + " " + number(p[1]) + " " + number(p[2]); }

std::string bounds_text(const Json& bounds) {
  return bounds.is_null() ? "empty" : point_text(bounds["min"]) + "  to  " + point_text(bounds["max"]) + "  (metres)";
}

std::string placed_text(const Json& info, const char* stored, const char* placed) {
  return number(info[stored]) + ", placed " + number(info[placed]) + (info[placed] == 1 ? " time" : " times");
}

std::string camera_text(const Json& camera) {
  const std::string name = camera["name"];
  const std::string view = camera.contains("yfov")
                               ? number(camera["yfov"].get<double>() * 180 / std::numbers::pi) + " degrees high"
                               : number(2 * camera["ymag"].get<double>()) + " m high";
  return number(camera["index"]) + (name.empty() ? "" : " '" + name + "'") + ", " + camera["kind"].get<std::string>() +
         ", " + view;
}

std::string light_text(const Json& light) {
  const std::string name = light["name"];
  return light["kind"].get<std::string>() + (name.empty() ? "" : " '" + name + "'");
}

std::string measured_text(const Json& brdf) {
  const Json& entries = brdf["entries"];
  return brdf["uri"].get<std::string>() + ", " + number(entries[0]) + " x " + number(entries[1]) + " x " +
         number(entries[2]) + " entries, " + number(std::round(brdf["known"].get<double>() * 100)) +
         " % known, highlight of roughness " + number(brdf["roughness"]);
}

/// The names, each after its index.
std::string animations_text(const Json& names) {
  std::string text;
  for (const Json& name : names) {
    const auto index = std::to_string(&name - &names[0]);
    text += (text.empty() ? "" : ", ") + index + (name == "" ? "" : " '" + name.get<std::string>() + "'");
  }
  return text.empty() ? "none" : text;
}

std::string extension_text(const Json& extension) {
  const std::string meaning = extension["meaning"];
  return extension["name"].get<std::string>() + (extension["required"].get<bool>() ? ", required, " : ", ") +
         extension["treatment"].get<std::string>() + (meaning.empty() ? "" : ": " + meaning);
}

std::string row(const std::string& title, const std::string& text) {
  return title + std::string(12 - std::min<size_t>(title.size(), 11), ' ') + text + "\n";
}

template <class Text>
std::string rows(const std::string& title, const Json& list, Text text_of) {
  if (list.empty()) return row(title, "none");
  std::string text;
  for (const Json& item : list) text += row(text.empty() ? title : "", text_of(item));
  return text;
}

std::string info_text(const Json& info) {
  return row("file", info["file"]) + row("nodes", number(info["nodes"])) +
         row("meshes", placed_text(info, "meshes", "mesh_instances")) +
         row("triangles", number(info["triangles"]) + ", as placed " + number(info["triangles_placed"])) +
         row("shapes", placed_text(info, "shapes", "shape_instances")) + row("materials", number(info["materials"])) +
         row("textures", number(info["textures"]) + ", of images " + number(info["images"])) +
         row("skins", number(info["skins"])) + row("animations", animations_text(info["animations"])) +
         rows("lights", info["lights"], light_text) + rows("cameras", info["cameras"], camera_text) +
         (info["measured"].empty() ? "" : rows("measured", info["measured"], measured_text)) +
         row("bounds", bounds_text(info["bounds"])) + rows("extensions", info["extensions"], extension_text) +
         row("loading", format_seconds(info["load_s"]) + ", without decoding images or building hierarchies");
}

int run_info(const std::string& file, const LoadLimits& limits, bool as_json) {
  const auto warn = [](const std::string& text) { std::fprintf(stderr, "warning: %s\n", text.c_str()); };
  const auto start = std::chrono::steady_clock::now();
  Json info = info_json(file, warn, std::make_shared<LoadBudget>(limits));
  info["load_s"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string text = as_json ? info.dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : info_text(info);
  print(text);
  return int(ExitStatus::done);
}

}  // namespace

Command add_info_command(CLI::App& program) {
  struct Arguments {
    std::string scene;
    LoadLimits limits;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("info", "Say what a scene holds")->group("Commands");
  command->add_option("SCENE", arguments->scene, "glTF 2.0 file (.gltf or .glb)")->type_name("")->required();
  command->add_flag("--json", arguments->json, "One JSON object instead of a table");
  command->option_defaults()->group("Limits");
  add_limit_options(*command, arguments->limits);
  command->footer("Example:\n  alhazen info scene.gltf --json");
  return {command, [arguments] { return run_info(arguments->scene, arguments->limits, arguments->json); }};
}

}  // namespace alhazen
