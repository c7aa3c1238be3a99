#include "procedural/nff_to_gltf.h"

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <span>
#include <string>

#include "accel/face_triangulation.h"
#include "procedural/tessellation.h"

namespace alhazen {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kVertices = 34962, kIndices = 34963;

Json json_of(const Vec3d& v) { return {v.x, v.y, v.z}; }
Json json_of(const Rgb& c) { return {c.r, c.g, c.b}; }
Json grey(float share) { return {share, share, share}; }

/// Column-major: axes x, y, z and the origin.
Json matrix(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin) {
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

/// The binary chunk and the accessors into it.
class Buffer {
 public:
  /// Positions get the bounds that glTF asks for.
  size_t add(std::span<const Vec3f> values, bool with_bounds) {
    Json accessor = {{"componentType", kFloat}, {"count", values.size()}, {"type", "VEC3"}};
    if (with_bounds) {
      Vec3f least = values[0], most = values[0];
      for (const Vec3f& v : values) least = min(least, v), most = max(most, v);
      accessor["min"] = {least.x, least.y, least.z}, accessor["max"] = {most.x, most.y, most.z};
    }
    return add(std::as_bytes(values), kVertices, std::move(accessor));
  }
  size_t add(std::span<const std::array<uint32_t, 3>> triangles) {
    return add(std::as_bytes(triangles), kIndices,
               {{"componentType", kUnsignedInt}, {"count", 3 * triangles.size()}, {"type", "SCALAR"}});
  }

  Json views = Json::array(), accessors = Json::array();
  std::vector<uint8_t> bytes;

 private:
  size_t add(std::span<const std::byte> data, int target, Json accessor) {
    views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}, {"target", target}});
    const auto* first = reinterpret_cast<const uint8_t*>(data.data());
    bytes.insert(bytes.end(), first, first + data.size());
    accessor["bufferView"] = views.size() - 1;
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }
};

/// What is written for the polygons of one material.
struct Faces {
  std::vector<Vec3f> positions, normals;  // normals of all or none
  std::vector<std::array<uint32_t, 3>> triangles;
};

class Writer {
 public:
  Writer(const NffScene& scene, const GltfForm& form) : scene_(scene), form_(form) {}

  std::vector<uint8_t> glb() {
    add_camera();
    add_lights();
    for (const NffMaterial& material : scene_.materials) materials_.push_back(material_json(material));
    for (const NffSphere& sphere : scene_.spheres) add_sphere(sphere);
    for (const NffCone& cone : scene_.cones) add_cone(cone);
    add_polygons();
    return packed(document());
  }

 private:
  void add_node(Json node) { nodes_.push_back(std::move(node)); }

  void add_camera() {
    const NffView& view = scene_.view;
    const Vec3d z = normalize(view.from - view.at), x = normalize(cross(view.up, z));
    add_node({{"name", "view"}, {"camera", 0}, {"matrix", matrix(x, cross(z, x), z, view.from)}});
  }

  void add_lights() {
    const auto n = double(scene_.lights.size());
    for (const NffLight& light : scene_.lights) {
      lights_.push_back({{"type", "point"},
                         {"color", json_of(light.color)},
                         {"intensity", light.has_color ? 1 : std::sqrt(n) / n},
                         {"extensions", {{"ALHAZEN_lights", {{"attenuation", "none"}}}}}});
      add_node({{"translation", json_of(light.p)},
                {"extensions", {{"KHR_lights_punctual", {{"light", lights_.size() - 1}}}}}});
    }
  }

  static Json material_json(const NffMaterial& m) {
    const Rgb diffuse = m.color * m.kd;
    Json phong = {{"ambientFactor", grey(0)}, {"diffuseFactor", json_of(diffuse)}, {"specularFactor", grey(m.ks)}};
    if (m.shine > 0) phong["shininess"] = m.shine;
    if (m.t > 0) phong["transmissionFactor"] = grey(m.t), phong["ior"] = std::max(1.0f, m.ior);
    const auto unit = [](float x) { return std::min(1.0f, x); };
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {unit(diffuse.r), unit(diffuse.g), unit(diffuse.b), 1}},
              {"metallicFactor", 0},
              {"roughnessFactor", m.shine > 0 ? std::pow(2 / (m.shine + 2), 0.25) : 1}}},
            {"extensions", {{"ALHAZEN_materials_phong", std::move(phong)}}}};
  }

  /// The number of a shape; the same shape has one number.
  size_t shape(const Json& shape) {
    const auto [at, is_new] = shape_numbers_.try_emplace(shape.dump(), shapes_.size());
    if (is_new) shapes_.push_back(shape);
    return at->second;
  }

  static Json placed(size_t shape, uint32_t material) {
    return {{"ALHAZEN_shapes", {{"shape", shape}, {"material", material}}}};
  }

  void add_sphere(const NffSphere& s) {
    if (!form_.tessellate)
      return add_node({{"translation", json_of(s.center)},
                       {"extensions", placed(shape({{"sphere", {{"radius", s.radius}}}}), s.material)}});
    const size_t mesh = tessellated("sphere", s.material, [&] { return tessellated_sphere(form_.segments); });
    add_node(
        {{"mesh", mesh}, {"translation", json_of(s.center)}, {"scale", json_of(Vec3d(s.radius, s.radius, s.radius))}});
  }

  /// The shape stands on y, its middle at the origin.
  void add_cone(const NffCone& c) {
    const double height = length(c.apex - c.base);
    const Vec3d y = (c.apex - c.base) / height;
    const Vec3d x = normalize(cross(y, std::abs(y.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
    Json node = {{"matrix", matrix(x, y, cross(x, y), (c.base + c.apex) * 0.5)}};
    const Json cylinder = {
        {"height", height}, {"radiusBottom", c.base_radius}, {"radiusTop", c.apex_radius}, {"caps", false}};
    if (form_.tessellate)
      node["mesh"] = tessellated(cylinder.dump(), c.material, [&] {
        return tessellated_frustum(height, c.base_radius, c.apex_radius, form_.segments);
      });
    else
      node["extensions"] = placed(shape({{"cylinder", cylinder}}), c.material);
    add_node(std::move(node));
  }

  /// The mesh of a round surface in a material; surfaces of the same name share their vertices.
  template <class Make>
  size_t tessellated(const std::string& name, uint32_t material, const Make& make) {
    const auto [at, is_new] = mesh_numbers_.try_emplace({name, material}, meshes_.size());
    if (!is_new) return at->second;
    const auto [soup, is_new_soup] = soups_.try_emplace(name);
    if (is_new_soup) {
      const TriangleSoup made = make();
      soup->second = {{"attributes",
                       {{"POSITION", buffer_.add(made.positions, true)}, {"NORMAL", buffer_.add(made.normals, false)}}},
                      {"indices", buffer_.add(made.triangles)}};
    }
    Json primitive = soup->second;
    primitive["material"] = material;
    meshes_.push_back({{"primitives", Json::array({std::move(primitive)})}});
    return at->second;
  }

  void add_polygons() {
    std::map<std::pair<uint32_t, bool>, Faces> by_material;
    for (const NffPolygon& polygon : scene_.polygons)
      add_polygon(polygon, by_material[{polygon.material, !polygon.normals.empty()}]);
    Json primitives = Json::array();
    for (const auto& [key, faces] : by_material) {
      if (faces.triangles.empty()) continue;
      Json primitive = {{"attributes", {{"POSITION", buffer_.add(faces.positions, true)}}},
                        {"indices", buffer_.add(faces.triangles)},
                        {"material", key.first}};
      if (key.second) primitive["attributes"]["NORMAL"] = buffer_.add(faces.normals, false);
      if (!form_.tessellate) primitive["extensions"] = {{"FB_ngon_encoding", Json::object()}};
      has_polygons_ = true;
      primitives.push_back(std::move(primitive));
    }
    if (primitives.empty()) return;
    meshes_.push_back({{"name", "polygons"}, {"primitives", std::move(primitives)}});
    add_node({{"mesh", meshes_.size() - 1}});
  }

  /// As a fan, which FB_ngon_encoding reads as a face whatever its outline; else as triangles that cover it.
  void add_polygon(const NffPolygon& polygon, Faces& faces) const {
    const auto first = uint32_t(faces.positions.size());
    for (const Vec3d& p : polygon.vertices) faces.positions.emplace_back(p);
    for (const Vec3d& n : polygon.normals) faces.normals.emplace_back(normalize(n));
    std::vector<std::array<uint32_t, 3>> triangles;
    if (form_.tessellate && polygon.vertices.size() > 3)
      triangles = triangulate(std::span(faces.positions).subspan(first));
    if (triangles.empty())
      for (uint32_t k = 2; k < polygon.vertices.size(); ++k) triangles.push_back({0, k - 1, k});
    for (const auto& [a, b, c] : triangles) faces.triangles.push_back({first + a, first + b, first + c});
  }

  [[nodiscard]] Json document() {
    std::set<std::string> used = {"ALHAZEN_lights", "ALHAZEN_materials_phong"};
    Json extensions = Json::object();
    if (!lights_.empty()) used.insert("KHR_lights_punctual"), extensions["KHR_lights_punctual"]["lights"] = lights_;
    if (!shapes_.empty()) used.insert("ALHAZEN_shapes"), extensions["ALHAZEN_shapes"]["shapes"] = shapes_;
    if (has_polygons_ && !form_.tessellate) used.insert("FB_ngon_encoding");
    Json roots = Json::array();
    for (size_t i = 0; i < nodes_.size(); ++i) roots.push_back(i);
    Json json = {{"asset", {{"version", "2.0"}, {"generator", "Alhazen"}}},
                 {"extensionsUsed", used},
                 {"scene", 0},
                 {"scenes",
                  {{{"nodes", std::move(roots)},
                    {"extensions", {{"ALHAZEN_lights", {{"background", json_of(scene_.background)}}}}}}}},
                 {"cameras",
                  {{{"type", "perspective"},
                    {"perspective", {{"yfov", scene_.view.angle * std::numbers::pi / 180}, {"znear", 1e-3}}}}}},
                 {"nodes", std::move(nodes_)}};
    const auto put = [&](const char* name, Json list) {
      if (!list.empty()) json[name] = std::move(list);
    };
    put("extensions", std::move(extensions)), put("materials", std::move(materials_)),
        put("meshes", std::move(meshes_));
    put("accessors", std::move(buffer_.accessors)), put("bufferViews", std::move(buffer_.views));
    if (!buffer_.bytes.empty()) json["buffers"] = {{{"byteLength", buffer_.bytes.size()}}};
    return json;
  }

  /// Header, JSON chunk, binary chunk; each padded to four bytes.
  [[nodiscard]] std::vector<uint8_t> packed(const Json& json) const {
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<uint8_t> file;
    const auto word = [&](uint32_t x) {
      for (int shift = 0; shift < 32; shift += 8) file.push_back(uint8_t(x >> shift));
    };
    const size_t binary = buffer_.bytes.size();  // of floats and integers: a multiple of four
    word(0x46546c67), word(2), word(uint32_t(12 + 8 + text.size() + (binary > 0 ? 8 + binary : 0)));
    word(uint32_t(text.size())), word(0x4e4f534a);
    file.insert(file.end(), text.begin(), text.end());
    if (binary == 0) return file;
    word(uint32_t(binary)), word(0x004e4942);
    file.insert(file.end(), buffer_.bytes.begin(), buffer_.bytes.end());
    return file;
  }

  const NffScene& scene_;
  const GltfForm& form_;
  Buffer buffer_;
  Json nodes_ = Json::array(), lights_ = Json::array(), materials_ = Json::array(), shapes_ = Json::array(),
       meshes_ = Json::array();
  std::map<std::string, size_t> shape_numbers_;
  std::map<std::pair<std::string, uint32_t>, size_t> mesh_numbers_;
  std::map<std::string, Json> soups_;
  bool has_polygons_ = false;
};

}  // namespace

std::vector<uint8_t> glb_of(const NffScene& scene, const GltfForm& form) { return Writer(scene, form).glb(); }

}  // namespace alhazen
