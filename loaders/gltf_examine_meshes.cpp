#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <set>

#include "loaders/gltf_examiner.h"

namespace alhazen {
namespace {

using nlohmann::json;

bool is_attribute_format(const AccessorView& a, const std::string& name) {
  const bool is_float = a.type == TINYGLTF_COMPONENT_TYPE_FLOAT;
  const bool is_small =
      a.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || a.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (name.starts_with("JOINTS_")) return is_small && a.components == 4;
  if (name.starts_with("WEIGHTS_")) return a.components == 4 && (is_float || (is_small && a.normalized));
  if (name.starts_with("COLOR_") || name.starts_with("TEXCOORD_")) return is_float || is_small;
  return true;
}

/// TEXCOORD_0, TEXCOORD_1 and so on without a gap. How many there are.
size_t consecutive(Examiner& e, const JsonRef& attributes, const std::string& prefix) {
  size_t here = 0, last = 0;
  for (const auto& item : attributes.value().items())
    if (item.key().starts_with(prefix)) {
      ++here;
      last = std::max(last, size_t(std::strtoul(item.key().c_str() + prefix.size(), nullptr, 10)));
    }
  e.unless(here == 0 || last == here - 1, attributes, "its " + prefix + "n are not numbered from 0 without a gap");
  return here;
}

bool is_known_name(const std::string& name) {
  const size_t stem = name.find('_');
  if (name.starts_with("_")) return true;
  if (stem == std::string::npos) return name == "POSITION" || name == "NORMAL" || name == "TANGENT";
  const std::string kind = name.substr(0, stem), number = name.substr(stem + 1);
  const bool digits = !number.empty() &&
                      std::all_of(number.begin(), number.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return digits && (kind == "TEXCOORD" || kind == "COLOR" || kind == "JOINTS" || kind == "WEIGHTS");
}

/// Directions that have no unit length: they are repaired.
void examine_directions(Examiner& e, const JsonRef& r, const AccessorView& accessor) {
  if (accessor.components < 3) return;
  constexpr float kTolerance = 0.0005f;  // the validator's, of the squared length
  std::vector<uint32_t> all(accessor.count);
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<float> v = floats(accessor, all);
  uint64_t wrong = 0;
  const size_t n = accessor.components;
  for (size_t i = 0; i + n <= v.size(); i += n) {
    wrong += !(std::abs(v[i] * v[i] + v[i + 1] * v[i + 1] + v[i + 2] * v[i + 2] - 1) <= kTolerance * 10);
    if (n == 4) wrong += std::abs(v[i + 3]) != 1;
  }
  e.unless(wrong == 0, r,
           std::to_string(wrong) + " of its directions have no unit length, or signs other than 1 and -1; repaired");
}

void examine_attribute(Examiner& e, const JsonRef& r, const std::string& name) {
  const JsonRef accessor = e.root()["accessors"][r.as<size_t>()];
  const AccessorView& view = e.buffers.accessor(r.as<int>());
  e.unless(is_known_name(name), r, "no attribute of the specification; names of one's own begin with _");
  e.unless(is_attribute_format(view, name), r, "its accessor's type is none that " + name + " may have");
  e.unless(name != "POSITION" || (accessor.has("min") && accessor.has("max")), r, "its accessor lacks min and max");
  e.unless(view.type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, r, "expected no accessor of 32-bit integers");
  e.unless(view.stride % 4 == 0 || !view.data, r, "its elements do not begin at multiples of 4 bytes");
  if ((name == "NORMAL" || name == "TANGENT") && view.data && e.first("directions", r.as<size_t>()))
    examine_directions(e, r, view);
  if (name.starts_with("COLOR_") && view.data && e.first("colors", r.as<size_t>()) &&
      view.type == TINYGLTF_COMPONENT_TYPE_FLOAT) {
    std::vector<uint32_t> all(view.count);
    std::iota(all.begin(), all.end(), 0u);
    const std::vector<float> v = floats(view, all);
    e.unless(std::all_of(v.begin(), v.end(), [](float c) { return c >= 0 && c <= 1; }), r,
             "has colours outside of 0 to 1");
  }
}

void examine_targets(Examiner& e, const JsonRef& primitive) {
  for (const JsonRef& target : primitive.elements("targets"))
    for (const auto& item : target.value().items()) {
      const auto base = primitive["attributes"].find(item.key());
      e.unless(base.has_value(), target[item.key()], "the primitive has no such attribute to move");
      const JsonRef accessor = e.root()["accessors"][item.value().get<size_t>()];
      e.unless(item.key() != "POSITION" || (accessor.has("min") && accessor.has("max")), target[item.key()],
               "its accessor lacks min and max");
      if (base)
        e.unless(e.buffers.accessor(base->as<int>()).count == e.buffers.accessor(item.value().get<int>()).count,
                 target[item.key()], "has another count than the attribute that it moves");
    }
}

void examine_indices(Examiner& e, const JsonRef& r) {
  const JsonRef accessor = e.root()["accessors"][r.as<size_t>()];
  const AccessorView& view = e.buffers.accessor(r.as<int>());
  if (const auto at = accessor.find("bufferView"))
    e.unless(!e.root()["bufferViews"][at->as<size_t>()].has("byteStride"), r, "its buffer view has a byteStride");
  if (!view.data || !view.is_unsigned_integer() || view.components != 1 || !e.first("indices", r.as<size_t>())) return;
  const uint64_t restart = view.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 0xff
                           : view.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 0xffff
                                                                                 : 0xffffffff;
  const std::vector<uint32_t> all = indices(view);
  e.unless(std::find(all.begin(), all.end(), restart) == all.end(), r, "holds the value that restarts primitives");
}

/// The largest texCoord anywhere in a material, and 1.
size_t uv_sets_of(const json& value) {
  size_t sets = 0;
  if (value.is_object() && value.contains("index") && value["index"].is_number_unsigned()) {
    sets = 1 + value.value("texCoord", uint64_t{0});
    if (value.contains("extensions") && value["extensions"].contains("KHR_texture_transform"))
      sets = std::max<size_t>(sets, 1 + value["extensions"]["KHR_texture_transform"].value("texCoord", uint64_t{0}));
  }
  if (value.is_structured())
    for (const json& part : value) sets = std::max(sets, uv_sets_of(part));
  return sets;
}

void examine_primitive(Examiner& e, const JsonRef& r) {
  const JsonRef attributes = r["attributes"];
  e.unless(!attributes.value().empty(), attributes, "is empty, expected one attribute or more");
  for (const auto& item : attributes.value().items()) examine_attribute(e, attributes[item.key()], item.key());
  const size_t uv_sets = consecutive(e, attributes, "TEXCOORD_");
  consecutive(e, attributes, "COLOR_");
  e.unless(consecutive(e, attributes, "JOINTS_") == consecutive(e, attributes, "WEIGHTS_"), attributes,
           "has not as many JOINTS_n as WEIGHTS_n");
  if (const auto index = r.find("indices")) examine_indices(e, *index);
  examine_targets(e, r);
  if (const auto material = r.find("material")) {
    const json& looks = e.root()["materials"][material->as<size_t>()].value();
    if (e.first("uv sets of " + std::to_string(uv_sets), material->as<size_t>()))
      e.unless(uv_sets_of(looks) <= uv_sets, *material, "its textures want TEXCOORD_n that the primitive lacks");
    const bool bends = looks.contains("normalTexture") ||
                       looks.value("extensions", json::object()).contains("KHR_materials_anisotropy") ||
                       looks.value("extensions", json::object())
                           .value("KHR_materials_clearcoat", json::object())
                           .contains("clearcoatNormalTexture");
    e.unless(!bends || attributes.has("TANGENT") || (attributes.has("NORMAL") && uv_sets > 0), *material,
             "needs tangents, and the primitive has neither TANGENT nor NORMAL and TEXCOORD_0");
    e.unless(
        !bends || attributes.has("TANGENT") || looks.contains("normalTexture"), *material,
        "needs tangents, and has neither TANGENT nor a normal texture to make them for; made for its other textures");
  }
}

void examine_each_mesh(Examiner& e) {
  for (const JsonRef& mesh : e.root().elements("meshes")) {
    const auto primitives = mesh.elements("primitives");
    const auto targets = [](const JsonRef& r) { return r.has("targets") ? r["targets"].value().size() : 0; };
    for (const JsonRef& r : primitives) {
      examine_primitive(e, r);
      e.unless(targets(r) == targets(primitives[0]), r, "has not as many morph targets as the mesh's first primitive");
    }
    if (const auto weights = mesh.find("weights"); weights && !primitives.empty())
      e.unless(weights->value().size() == targets(primitives[0]), *weights, "has not one weight for each morph target");
  }
}

/// Attributes of one buffer view that several accessors share have to say how far apart elements are.
void examine_strides(Examiner& e) {
  std::set<std::pair<size_t, size_t>> seen;
  std::vector<size_t> users(e.root().elements("bufferViews").size());
  std::set<size_t> counted;
  for (const JsonRef& mesh : e.root().elements("meshes"))
    for (const JsonRef& primitive : mesh.elements("primitives"))
      for (const auto& item : primitive["attributes"].value().items()) {
        const auto index = item.value().get<size_t>();
        const auto view = e.root()["accessors"][index].find("bufferView");
        if (view && counted.insert(index).second) ++users[view->as<size_t>()];
      }
  const auto views = e.root().elements("bufferViews");
  for (size_t i = 0; i < users.size(); ++i)
    e.unless(users[i] < 2 || views[i].has("byteStride"), views[i],
             "`byteStride` is missing, which a view of several vertex attributes needs");
}

}  // namespace

void examine_meshes(Examiner& e) {
  examine_each_mesh(e);
  examine_strides(e);
}

}  // namespace alhazen
