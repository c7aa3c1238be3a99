#include "crosscheck/stated_case.h"

#include <algorithm>

#include "crosscheck/json_reader.h"

namespace alhazen::crosscheck {
namespace {

constexpr int kDeepestTree = 32;  // of operations within operations

Affine3d map_from(const JsonReader& in) {
  const auto columns = in.elements(4);
  const Affine3d m{columns[0].finite_vector(), columns[1].finite_vector(), columns[2].finite_vector(),
                   columns[3].finite_vector()};
  in.expect(is_invertible(m), "columns of an invertible map");
  return m;
}

Sphere sphere_from(const JsonReader& in) {
  const Sphere s{in["radius"].finite_number()};
  in.expect(s.radius > 0, "a radius > 0");
  return s;
}

Cylinder cylinder_from(const JsonReader& in) {
  const Cylinder c{in["height"].finite_number(), in["radius_bottom"].finite_number(), in["radius_top"].finite_number(),
                   in["caps"].boolean()};
  in.expect(c.height > 0 && c.radius_bottom >= 0 && c.radius_top >= 0 && c.radius_bottom + c.radius_top > 0,
            "a height > 0 and radii >= 0, not both 0");
  return c;
}

Disk disk_from(const JsonReader& in) {
  const Disk d{in["radius"].finite_number(), in["inner_radius"].finite_number()};
  in.expect(d.radius > d.inner_radius && d.inner_radius >= 0, "a radius > an inner radius >= 0");
  return d;
}

Box box_from(const JsonReader& in) {
  const Box b{in["size"].finite_vector()};
  in.expect(b.size.x > 0 && b.size.y > 0 && b.size.z > 0, "sizes > 0");
  return b;
}

Quadric quadric_from(const JsonReader& in) {
  Quadric q;
  const auto coefficients = in["coefficients"].elements(q.coefficients.size());
  for (size_t k = 0; k < coefficients.size(); ++k) q.coefficients[k] = coefficients[k].finite_number();
  q.solid = in["solid"].boolean();
  q.whole = in.has("whole") && in["whole"].boolean();
  if (q.whole) {
    const auto box = ellipsoid_bounds(q.coefficients);
    in.expect(box.has_value(), "coefficients of an ellipsoid, as it is whole");
    q.box = *box;
  } else {
    q.box = {in["min"].finite_vector(), in["max"].finite_vector()};
    in.expect(!is_empty(q.box), "min <= max");
  }
  return q;
}

Triangle triangle_from(const JsonReader& in) {
  const auto vertices = in.elements(3);
  return {vertices[0].finite_vector(), vertices[1].finite_vector(), vertices[2].finite_vector()};
}

Polygon polygon_from(const JsonReader& in) {
  std::vector<std::vector<Vec3d>> loops;
  for (const JsonReader& loop : in["loops"].elements()) {
    loops.emplace_back();
    for (const JsonReader& vertex : loop.elements()) loops.back().push_back(vertex.finite_vector());
  }
  try {
    return make_polygon(loops);
  } catch (const PolygonError& error) {
    in["loops"].fail("loops that make a polygon (" + std::string(error.what()) + ")");
  }
}

ClosedBody body_from(const JsonReader& in) {
  if (in.has("sphere")) return sphere_from(in["sphere"]);
  if (in.has("box")) return box_from(in["box"]);
  if (in.has("cylinder")) {
    const Cylinder c = cylinder_from(in["cylinder"]);
    in.expect(c.caps, "a cylinder with caps: a closed body");
    return c;
  }
  if (in.has("quadric")) {
    const Quadric q = quadric_from(in["quadric"]);
    in.expect(q.solid || q.whole, "a solid quadric: a closed body");
    return q;
  }
  in.fail("a sphere, box, cylinder or quadric, or an operation");
}

/// Fills `whole` with a tree, in the order of `make_composite`.
class TreeReader {
 public:
  explicit TreeReader(Composite& whole) : whole_(whole) { whole_.nodes.resize(1); }

  void read(const JsonReader& in, size_t at = 0, bool reversed = false, int depth = 0) {
    using Operation = CompositeNode::Operation;
    if (!in.has("operation")) return read_leaf(in, at, reversed);
    const std::string name = in["operation"].text();
    const std::string names[] = {"union", "intersection", "difference"};
    const auto* found = std::find(std::begin(names), std::end(names), name);
    in["operation"].expect(found != std::end(names), "union, intersection or difference");
    const auto operands = in["operands"].elements();
    in["operands"].expect(!operands.empty() && depth < kDeepestTree,
                          "one or more operands, in a tree of up to 32 levels");
    const auto operation = Operation(1 + (found - std::begin(names)));
    const size_t first = whole_.nodes.size();
    whole_.nodes[at] = {operation, uint32_t(first), uint32_t(operands.size())};
    whole_.nodes.resize(first + operands.size());
    for (size_t k = 0; k < operands.size(); ++k)
      read(operands[k], first + k, reversed != (operation == Operation::subtract && k > 0), depth + 1);
  }

 private:
  void read_leaf(const JsonReader& in, size_t at, bool reversed) {
    CompositeLeaf leaf{body_from(in), {}, {}, reversed};
    for (const JsonReader& map : in["maps"].elements()) leaf.chain.push_back(map_from(map));
    in["maps"].expect(!leaf.chain.empty(), "one or more maps");
    leaf.body_from_composite = line_map(leaf.chain);
    whole_.nodes[at] = {CompositeNode::Operation::leaf, uint32_t(whole_.leaves.size()), 0};
    whole_.leaves.push_back(std::move(leaf));
  }

  Composite& whole_;
};

Composite composite_from(const JsonReader& in) {
  Composite composite;
  TreeReader(composite).read(in);
  return composite;
}

Surface surface_from(const JsonReader& in) {
  if (in.has("sphere")) return sphere_from(in["sphere"]);
  if (in.has("cylinder")) return cylinder_from(in["cylinder"]);
  if (in.has("disk")) return disk_from(in["disk"]);
  if (in.has("box")) return box_from(in["box"]);
  if (in.has("quadric")) return quadric_from(in["quadric"]);
  if (in.has("triangle")) return triangle_from(in["triangle"]);
  if (in.has("polygon")) return polygon_from(in["polygon"]);
  if (in.has("composite")) return composite_from(in["composite"]);
  in.fail("one of sphere, cylinder, disk, box, quadric, triangle, polygon, composite");
}

Rayf ray_from(const JsonReader& in) {
  return {in["origin"].float_vector(), in["direction"].float_vector(), in["t_min"].float_number(),
          in["t_max"].float_number()};
}

Judgement truth_from(const JsonReader& in) {
  Judgement truth;
  truth.hit = in["hit"].boolean();
  if (truth.hit) truth.t = in["t"].float_number(), truth.face = int(in["face"].finite_number());
  const std::string name = in["tie"].text();
  for (const Tie tie : {Tie::none, Tie::edge, Tie::tangent, Tie::coplanar})
    if (name == name_of(tie)) return truth.tie = tie, truth;
  in["tie"].fail("none, edge, tangent or coplanar");
}

}  // namespace

StatedCase stated_case(const Json& json, const std::string& file) {
  const JsonReader in(json, file);
  const JsonReader subject = in["subject"];
  StatedCase stated{{surface_from(subject), map_from(subject["world_from_object_columns"])}, ray_from(in["ray"])};
  if (in.has("embree") && in["embree"].has("scene_flags_B"))
    stated.robust_native = in["embree"]["scene_flags_B"].text() == "robust";
  if (in.has("J")) stated.truth = truth_from(in["J"]);
  if (in.has("about")) stated.about = in["about"].text();
  return stated;
}

bool is_as_stated(const Judgement& truth, const StatedCase& stated) {
  return !stated.truth || (same_answer(truth, *stated.truth) && truth.tie == stated.truth->tie);
}

}  // namespace alhazen::crosscheck
