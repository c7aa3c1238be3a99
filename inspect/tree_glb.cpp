#include "inspect/tree_glb.h"

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "inspect/labels.h"
#include "inspect/tree_words.h"
#include "materials/microfacet.h"

namespace alhazen {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kLines = 1;
constexpr double kThickest = 0.004, kThinnest = 0.0008, kBeyond = 1.0 / 3;  // of the scene's size

// Materials: by RayKind, then total internal reflection, light that arrives, light that does not.
struct Paint {
  const char* name;
  Rgb color;
};
constexpr std::array kPaints{Paint{"camera", Rgb(0.8f)},
                             Paint{"mirror", {0.08f, 0.3f, 0.9f}},
                             Paint{"refracted", {0.03f, 0.6f, 0.35f}},
                             Paint{"straight on", Rgb(0.4f)},
                             Paint{"total internal reflection", {0.5f, 0.12f, 0.8f}},
                             Paint{"light", {1, 0.75f, 0.1f}},
                             Paint{"shadow", {0.6f, 0.03f, 0.03f}}};
constexpr size_t kLightPaint = 5, kShadowPaint = 6;

Json matrix_json(const Affine3d& m) {
  return {m.x.x, m.x.y, m.x.z, 0, m.y.x,      m.y.y,      m.y.z,      0,
          m.z.x, m.z.y, m.z.z, 0, m.origin.x, m.origin.y, m.origin.z, 1};
}

/// Takes the y axis from -1/2 to 1/2 to the segment, circles of radius 1 about it to circles of that radius.
Affine3d segment_map(const Vec3d& from, const Vec3d& to, double radius) {
  const ShadingFrame frame = frame_about(Vec3f(normalize(to - from)));
  return {Vec3d(frame.t) * radius, to - from, Vec3d(frame.b) * radius, (from + to) * 0.5};
}

class Writer {
 public:
  Writer(const Scene& scene, const RayTree& tree) : scene_(scene), tree_(tree) {
    Bounds3d bounds = world_bounds(scene.geometry);
    for (const TreeRay& ray : tree.rays) extend(bounds, Vec3d(ray.ray.origin));
    size_ = is_empty(bounds) ? 1 : std::max(length(bounds.upper - bounds.lower), 1e-6);
    for (const TreeRay& ray : tree.rays) add_ray(ray);
  }

  [[nodiscard]] std::vector<uint8_t> glb() const {
    return packed(document().dump(-1, ' ', false, Json::error_handler_t::replace));
  }

 private:
  void add_ray(const TreeRay& ray) {
    if (ray.end == RayEnd::depth_limit || ray.end == RayEnd::weight_limit) return;
    const Vec3d from(ray.ray.origin);
    const Vec3d to = ray.hit ? ray.hit->p_world : from + Vec3d(ray.ray.direction) * (kBeyond * size_);
    const std::string name = kind_text(ray) + ": " + start_name(ray) + " → " + target_text(scene_, ray);
    const double weight = std::sqrt(double(std::min(1.0f, max_component(ray.weight))));
    add_segment(name, from, to, kThinnest + (kThickest - kThinnest) * weight, ray.total ? 4 : size_t(ray.kind));
    for (const TreeLight& light : ray.lights) add_shadow(target_text(scene_, ray), light);
  }

  [[nodiscard]] std::string start_name(const TreeRay& ray) const {
    return ray.parent == kNone ? "camera" : target_text(scene_, tree_.rays[ray.parent]);
  }

  /// To the light, or to what hides it.
  void add_shadow(const std::string& surface, const TreeLight& light) {
    const bool hidden = !(max_component(light.visible) > 0) && !light.occluders.empty();
    const double far = std::isfinite(light.distance) ? double(light.distance) : kBeyond * size_;
    const double reach = hidden ? double(light.occluders.back().distance) : far;
    const Vec3d from(light.shadow.origin), along(normalize(light.shadow.direction));
    const std::string end = hidden ? node_label(scene_, light.occluders.back().node) + ", hiding " : "";
    add_segment("shadow: " + surface + " → " + end + light_label(scene_, light.light), from, from + along * reach,
                kThinnest, hidden ? kShadowPaint : kLightPaint);
  }

  void add_segment(const std::string& name, const Vec3d& from, const Vec3d& to, double radius, size_t paint) {
    if (!(length(to - from) > 1e-9 * size_)) return;
    nodes_.push_back({{"name", name},
                      {"mesh", paint},
                      {"matrix", matrix_json(segment_map(from, to, radius * size_))},
                      {"extensions", {{"ALHAZEN_shapes", {{"shape", 0}, {"material", paint}}}}}});
  }

  [[nodiscard]] Json document() const {
    Json json{{"asset", {{"version", "2.0"}, {"generator", "Alhazen"}}},
              {"extensionsUsed", {"ALHAZEN_lights", "ALHAZEN_shapes", "KHR_materials_unlit"}}};
    json["extensions"]["ALHAZEN_shapes"]["shapes"] = {
        {{"cylinder", {{"height", 1}, {"radiusBottom", 1}, {"radiusTop", 1}}}}};
    json["scene"] = 0;
    Json list = Json::array();
    for (size_t i = 0; i < nodes_.size(); ++i) list.push_back(i);
    json["scenes"] = {{{"nodes", list}, {"extensions", {{"ALHAZEN_lights", {{"background", {0.02, 0.02, 0.025}}}}}}}};
    json["nodes"] = nodes_;
    for (size_t i = 0; i < kPaints.size(); ++i) {
      const Rgb& c = kPaints[i].color;
      json["materials"].push_back({{"name", kPaints[i].name},
                                   {"pbrMetallicRoughness", {{"baseColorFactor", {c.r, c.g, c.b, 1}}}},
                                   {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
      json["meshes"].push_back(
          {{"name", kPaints[i].name},
           {"primitives", {{{"attributes", {{"POSITION", 0}}}, {"mode", kLines}, {"material", i}}}}});
    }
    json["accessors"] = {{{"bufferView", 0},
                          {"componentType", kFloat},
                          {"count", 2},
                          {"type", "VEC3"},
                          {"min", {0, -0.5, 0}},
                          {"max", {0, 0.5, 0}}}};
    json["bufferViews"] = {{{"buffer", 0}, {"byteLength", sizeof kLine}}};
    json["buffers"] = {{{"byteLength", sizeof kLine}}};
    return json;
  }

  /// Header, the JSON padded with spaces, and the ends of the one line that all share.
  static std::vector<uint8_t> packed(std::string json) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::vector<uint8_t> bytes;
    const auto put = [&](const void* data, size_t size) {
      const auto* first = static_cast<const uint8_t*>(data);
      bytes.insert(bytes.end(), first, first + size);
    };
    const auto word = [&](size_t value) {
      const auto w = uint32_t(value);
      put(&w, sizeof w);
    };
    put("glTF", 4), word(2), word(12 + 8 + json.size() + 8 + sizeof kLine);
    word(json.size()), put("JSON", 4), put(json.data(), json.size());
    word(sizeof kLine), put("BIN\0", 4), put(kLine, sizeof kLine);
    return bytes;
  }

  static constexpr float kLine[6] = {0, -0.5f, 0, 0, 0.5f, 0};

  const Scene& scene_;
  const RayTree& tree_;
  double size_ = 1;  // metres
  Json nodes_ = Json::array();
};

}  // namespace

std::vector<uint8_t> tree_glb(const Scene& scene, const RayTree& tree) { return Writer(scene, tree).glb(); }

}  // namespace alhazen
