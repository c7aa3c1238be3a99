#include "inspect/tree_json.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "inspect/labels.h"
#include "inspect/tree_words.h"

namespace alhazen {
namespace {

using Json = nlohmann::ordered_json;

/// As a double whose shortest decimal is the float's; null for what JSON has no number for.
Json number(float v) {
  if (!std::isfinite(v)) return nullptr;
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, v).ptr;
  double wide = 0;
  std::from_chars(text, end, wide);
  return wide;
}

Json list(const Rgb& c) { return {number(c.r), number(c.g), number(c.b)}; }
Json list(const Vec3f& v) { return {number(v.x), number(v.y), number(v.z)}; }
Json list(const Vec3d& v) { return {v.x, v.y, v.z}; }

/// {"index": 3, "name": "lens"}; the index is null for what the file has none for.
Json part(uint32_t index, const std::string& name) {
  return {{"index", index == kNone ? Json() : Json(index)}, {"name", name}};
}

Json hit_json(const Scene& scene, const TreeHit& hit) {
  Json json{{"node", part(hit.ids.node, node_label(scene, hit.ids.node))},
            {"object", object_label(scene.geometry, hit.object)},
            {"primitive", hit.ids.primitive},
            {"material", part(hit.ids.material, material_label(scene, hit.material))},
            {"distance", number(hit.distance)},
            {"position", list(hit.p_world)},
            {"normal", list(hit.ns_world)},
            {"geometric_normal", list(hit.ng_world)}};
  if (hit.uv) json["uv"] = {number(hit.uv->x), number(hit.uv->y)};
  json["enters"] = hit.enters, json["alpha"] = number(hit.alpha), json["arriving"] = list(hit.arriving);
  return json;
}

Json interface_json(const TreeRay& ray) {
  const Interface& i = *ray.interface;
  Json json{{"ior", {list(i.ior_before), list(i.ior_after)}}, {"incident_degrees", number(incident_degrees(ray))}};
  json["refracted_degrees"] = i.total ? Json() : number(refracted_degrees(ray));
  json["fresnel"] = i.fresnel_counts ? list(i.fresnel) : Json();
  json["total_internal_reflection"] = i.total;
  return json;
}

Json light_json(const Scene& scene, const TreeLight& light) {
  Json occluders = Json::array();
  for (const Occluder& o : light.occluders)
    occluders.push_back({{"node", part(o.node, node_label(scene, o.node))},
                         {"material", part(o.material, material_label(scene, o.material))},
                         {"distance", number(o.distance)},
                         {"transmittance", list(o.transmittance)}});
  return {{"light", part(light.light, light_label(scene, light.light))},
          {"origin", list(light.shadow.origin)},
          {"direction", list(normalize(light.shadow.direction))},
          {"distance", number(light.distance)},
          {"attenuation", list(light.attenuation)},
          {"arriving", list(light.arriving)},
          {"diffuse", list(light.diffuse)},
          {"specular", list(light.specular)},
          {"visible", list(light.visible)},
          {"occluders", occluders},
          {"contribution", list(light.addend.light)},
          {"order", light.addend.order}};
}

Json ray_json(const Scene& scene, const TreeRay& ray, bool branches, const Rgb& branch) {
  Json json{{"parent", ray.parent == kNone ? Json() : Json(ray.parent)},
            {"kind", kind_text(ray)},
            {"depth", ray.depth},
            {"weight", list(ray.weight)},
            {"origin", list(ray.ray.origin)},
            {"direction", list(ray.ray.direction)}};
  json["media"] = Json::array();
  for (const uint32_t material : ray.media) json["media"].push_back(material_label(scene, material));
  json["end"] = end_text(ray, branches);
  json["uncovered"] = number(ray.uncovered);
  json["hit"] = ray.hit ? hit_json(scene, *ray.hit) : Json();
  json["interface"] = ray.interface ? interface_json(ray) : Json();
  json["terms"] = Json::array(), json["lights"] = Json::array();
  for (const TermAddend& t : ray.terms)
    json["terms"].push_back(
        {{"term", term_text(t.term)}, {"contribution", list(t.addend.light)}, {"order", t.addend.order}});
  for (const TreeLight& light : ray.lights) json["lights"].push_back(light_json(scene, light));
  json["own"] = list(own_light(ray)), json["branch"] = list(branch);
  return json;
}

}  // namespace

std::string tree_json(const Scene& scene, const RayTree& tree, int indent) {
  Json json{{"pixel", {tree.x, tree.y}},      {"size", {tree.width, tree.height}}, {"sample", tree.sample},
            {"samples", tree.samples},        {"value", list(tree.pixel)},         {"alpha", number(tree.alpha)},
            {"radiance", list(tree.radiance)}};
  if (tree.time) json["time"] = number(*tree.time);
  json["rays"] = Json::array();
  const auto lists = children(tree);
  const std::vector<Rgb> branch = branch_light(tree);
  for (size_t i = 0; i < tree.rays.size(); ++i)
    json["rays"].push_back(ray_json(scene, tree.rays[i], !lists[i].empty(), branch[i]));
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace alhazen
