#include "crosscheck/subject_json.h"

#include <cstdio>

namespace alhazen::crosscheck {
namespace {

Json map_json(const Affine3d& m) { return {hex(m.x), hex(m.y), hex(m.z), hex(m.origin)}; }

Json surface_json(const Sphere& s) { return {{"sphere", {{"radius", hex(s.radius)}}}}; }
Json surface_json(const Cylinder& c) {
  return {{"cylinder",
           {{"height", hex(c.height)},
            {"radius_bottom", hex(c.radius_bottom)},
            {"radius_top", hex(c.radius_top)},
            {"caps", c.caps}}}};
}
Json surface_json(const Disk& d) {
  return {{"disk", {{"radius", hex(d.radius)}, {"inner_radius", hex(d.inner_radius)}}}};
}
Json surface_json(const Box& b) { return {{"box", {{"size", hex(b.size)}}}}; }
Json surface_json(const Quadric& q) {
  Json coefficients = Json::array();
  for (const double c : q.coefficients) coefficients.push_back(hex(c));
  Json json{{"coefficients", coefficients}, {"solid", q.solid}};
  if (q.whole)
    json["whole"] = true;  // its box follows from the coefficients
  else
    json["min"] = hex(q.box.lower), json["max"] = hex(q.box.upper);
  return {{"quadric", json}};
}
Json surface_json(const Triangle& t) { return {{"triangle", {hex(t.a), hex(t.b), hex(t.c)}}}; }
Json surface_json(const Polygon& p) {
  Json loops = Json::array();
  for (const auto& vertices : loops_of(p)) {
    loops.push_back(Json::array());
    for (const Vec3d& v : vertices) loops.back().push_back(hex(v));
  }
  return {{"polygon", {{"loops", loops}}}};
}

/// A part of the tree: a body under its maps, the outermost first, or an operation on such parts.
Json part_json(const Composite& c, const CompositeNode& node) {
  constexpr const char* kOperations[] = {"leaf", "union", "intersection", "difference"};
  if (node.operation == CompositeNode::Operation::leaf) {
    const CompositeLeaf& leaf = c.leaves[node.first];
    Json json = std::visit([](const auto& b) { return surface_json(b); }, leaf.body);
    json["maps"] = Json::array();
    for (const Affine3d& m : leaf.chain) json["maps"].push_back(map_json(m));
    return json;
  }
  Json operands = Json::array();
  for (uint32_t k = 0; k < node.count; ++k) operands.push_back(part_json(c, c.nodes[node.first + k]));
  return {{"operation", kOperations[size_t(node.operation)]}, {"operands", operands}};
}
Json surface_json(const Composite& c) { return {{"composite", part_json(c, c.nodes.front())}}; }

}  // namespace

std::string hex(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", x);
  return text;
}
Json hex(const Vec3d& v) { return {hex(v.x), hex(v.y), hex(v.z)}; }

Json to_json(const Subject& subject) {
  Json json = std::visit([](const auto& s) { return surface_json(s); }, subject.surface);
  if (!subject.origin.empty()) json["from"] = subject.origin;
  json["world_from_object_columns"] = map_json(subject.world_from_object);
  return json;
}

Json to_json(const Rayf& ray) {
  return {{"origin", hex(Vec3d(ray.origin))},
          {"direction", hex(Vec3d(ray.direction))},
          {"t_min", hex(ray.t_min)},
          {"t_max", hex(ray.t_max)}};
}

}  // namespace alhazen::crosscheck
