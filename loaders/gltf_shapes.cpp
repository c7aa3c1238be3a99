#include "loaders/gltf_shapes.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

namespace alhazen {
namespace {

using Operation = CompositeNode::Operation;

constexpr size_t kMostLeaves = 65536;  // of one composite: nesting can double them at every level
constexpr int kDeepestComposite = 128;
constexpr uint64_t kShapeBytes = 2 * sizeof(Shape);

/// Reads shapes in any order, so that composites find their operands.
class ShapeReader {
 public:
  ShapeReader(const JsonRef& extension, LoadBudget& budget)
      : list_(extension.elements("shapes")), shapes_(list_.size()), budget_(budget) {}

  /// `asked`: where the index stands, for what is wrong with it.
  const Shape& read(size_t index, const JsonRef& asked);
  [[nodiscard]] std::vector<Shape> read_all();
  [[nodiscard]] LoadBudget& budget() const { return budget_; }

 private:
  std::vector<JsonRef> list_;
  std::vector<std::optional<Shape>> shapes_;
  std::vector<size_t> open_;  // composites being read, the outermost first
  LoadBudget& budget_;
};

/// One row for each kind of shape: its key, what its fields have to be, and what they make.
struct Kind {
  std::string key;
  Check fields;
  Shape (*read)(const JsonRef& fields, ShapeReader& others);  // LoadError for what no single field can be blamed for
};

Vec3d read_vec3(const JsonRef& r) {
  const auto v = r.as<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

Shape read_sphere(const JsonRef& r, ShapeReader&) { return Sphere{r.get("radius", 1.0)}; }

Shape read_cylinder(const JsonRef& r, ShapeReader&) {
  const Cylinder cylinder{r.get("height", 1.0), r.get("radiusBottom", 0.5), r.get("radiusTop", 0.5),
                          r.get("caps", true)};
  if (cylinder.radius_bottom == 0 && cylinder.radius_top == 0)
    r.fail("radiusBottom and radiusTop are both 0, expected at most one to be");
  return cylinder;
}

Shape read_disk(const JsonRef& r, ShapeReader&) {
  const Disk disk{r.get("radius", 1.0), r.get("innerRadius", 0.0)};
  if (!(disk.inner_radius < disk.radius)) r["innerRadius"].expected("a number less than the radius");
  return disk;
}

Shape read_box(const JsonRef& r, ShapeReader&) { return Box{r.has("size") ? read_vec3(r["size"]) : Vec3d{1, 1, 1}}; }

Shape read_polygon(const JsonRef& r, ShapeReader&) {
  std::vector<std::vector<Vec3d>> loops;
  for (const JsonRef& loop : r.elements("loops")) {
    auto& points = loops.emplace_back();
    for (const JsonRef& point : loop.elements()) points.push_back(read_vec3(point));
  }
  try {
    return make_polygon(loops);
  } catch (const PolygonError& error) {
    r["loops"][error.loop].fail(error.what());
  }
}

Bounds3d read_bounds(const JsonRef& r) {
  const Bounds3d box{read_vec3(r["min"]), read_vec3(r["max"])};
  for (int axis = 0; axis < 3; ++axis)
    if (!(box.lower[axis] < box.upper[axis]))
      r["max"][size_t(axis)].expected("a number greater than " + r["min"][size_t(axis)].value().dump());
  return box;
}

Shape read_quadric(const JsonRef& r, ShapeReader&) {
  Quadric quadric;
  quadric.coefficients = r["coefficients"].as<std::array<double, 10>>();
  const auto& c = quadric.coefficients;
  if (std::all_of(c.begin(), c.end(), [](double x) { return x == 0; }))
    r["coefficients"].fail("all are 0, expected one that is not");
  quadric.solid = r.get("solid", false);
  if (r.has("bounds")) {
    quadric.box = read_bounds(r["bounds"]);
    return quadric;
  }
  const auto box = ellipsoid_bounds(c);
  if (!box) r.fail("`bounds` is missing, and only ellipsoids (A ... F definite) can do without");
  const bool inside_is_bounded = c[0] > 0;
  if (quadric.solid && !inside_is_bounded)
    r.fail("`bounds` is missing, and f < 0 outside of the ellipsoid: expected `bounds` or the other sign");
  quadric.box = *box, quadric.whole = true;
  quadric.solid = inside_is_bounded;  // a whole ellipsoid is a closed body of its own accord
  return quadric;
}

Affine3d read_matrix(const JsonRef& r) {
  const auto m = r.as<std::array<double, 16>>();
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) r.fail("expected the last row to be 0, 0, 0, 1");
  const Affine3d map{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  if (!is_invertible(map)) r.fail("expected a matrix that can be inverted");
  return map;
}

/// As an operand; none if the shape is not a closed body.
std::optional<std::variant<ClosedBody, Composite>> closed_body(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return *sphere;
  if (const auto* box = std::get_if<Box>(&shape)) return *box;
  if (const auto* composite = std::get_if<Composite>(&shape)) return *composite;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape); cylinder && cylinder->caps) return *cylinder;
  if (const auto* quadric = std::get_if<Quadric>(&shape); quadric && quadric->solid) return *quadric;
  return {};
}

size_t leaf_count(const Shape& operand) {
  const auto* composite = std::get_if<Composite>(&operand);
  return composite ? composite->leaves.size() : 1;
}

/// What the operand takes as a part of a composite.
uint64_t operand_bytes(const Shape& operand) {
  constexpr uint64_t kLeaf = 2 * sizeof(CompositeLeaf) + 2 * sizeof(CompositeNode), kMap = 3 * sizeof(Affine3d);
  const auto* composite = std::get_if<Composite>(&operand);
  uint64_t bytes = kLeaf + kMap;
  if (composite)
    for (const CompositeLeaf& leaf : composite->leaves) bytes += kLeaf + kMap * (1 + leaf.chain.size());
  return bytes;
}

Shape read_composite(const JsonRef& r, ShapeReader& others) {
  const auto name = r["operation"].as<std::string>();
  std::vector<CompositeOperand> operands;
  size_t leaves = 0;
  for (const JsonRef& operand : r.elements("operands")) {
    const JsonRef index = operand["shape"];
    const Shape& shape = others.read(index.as<size_t>(), index);
    leaves += leaf_count(shape);
    if (leaves > kMostLeaves) r.fail("is made of more than " + std::to_string(kMostLeaves) + " bodies");
    others.budget().take(r, operand_bytes(shape));
    const auto body = closed_body(shape);
    if (!body)
      index.fail(
          "shape " + index.value().dump() +
          " is not a closed body, expected a sphere, cylinder with caps, box, solid quadric, whole ellipsoid with "
          "f < 0 inside, or composite");
    operands.push_back({*body, operand.has("matrix") ? read_matrix(operand["matrix"]) : Affine3d{}});
  }
  return make_composite(name == "union"          ? Operation::unite
                        : name == "intersection" ? Operation::intersect
                                                 : Operation::subtract,
                        operands);
}

const std::vector<Kind>& kinds() {
  const Check length = number_above(0), radius = number(0), point = numbers(3);
  static const std::vector<Kind> all{
      {"sphere", closed_object({{"radius", length}}), read_sphere},
      {"cylinder",
       closed_object({{"height", length}, {"radiusBottom", radius}, {"radiusTop", radius}, {"caps", boolean()}}),
       read_cylinder},
      {"disk", closed_object({{"radius", length}, {"innerRadius", radius}}), read_disk},
      {"box", closed_object({{"size", both(numbers(3), list_of(length))}}), read_box},
      {"polygon", closed_object({{"loops", list_of(list_of(point, 3), 1), required}}), read_polygon},
      {"quadric",
       closed_object({{"coefficients", numbers(10), required},
                      {"bounds", closed_object({{"min", point, required}, {"max", point, required}})},
                      {"solid", boolean()}}),
       read_quadric},
      {"composite",
       closed_object({{"operation", one_of(std::vector<std::string>{"union", "intersection", "difference"}), required},
                      {"operands",
                       list_of(closed_object({{"shape", index_into("/extensions/ALHAZEN_shapes/shapes"), required},
                                              {"matrix", numbers(16)}}),
                               1),
                       required}}),
       read_composite},
  };
  return all;
}

const Kind* find_kind(const std::string& key) {
  const auto at = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& k) { return k.key == key; });
  return at == kinds().end() ? nullptr : &*at;
}

/// The keys of a shape that are not glTF's own.
std::vector<std::string> kind_keys(const JsonRef& shape) {
  std::vector<std::string> keys;
  for (const auto& item : shape.value().items())
    if (item.key() != "name" && item.key() != "extensions" && item.key() != "extras") keys.push_back(item.key());
  return keys;
}

std::string known_keys() {
  std::string keys;
  for (const Kind& kind : kinds()) keys += (keys.empty() ? "" : ", ") + kind.key;
  return keys;
}

void check_shape(const JsonRef& r) {
  object({{"name", text()}})(r);
  const std::vector<std::string> keys = kind_keys(r);
  for (const std::string& key : keys)
    if (!find_kind(key)) r.fail("unknown shape \"" + key + "\", expected one of " + known_keys());
  if (keys.size() != 1) r.fail("found " + std::to_string(keys.size()) + " shapes, expected one of " + known_keys());
  find_kind(keys[0])->fields(r[keys[0]]);
}

const Shape& ShapeReader::read(size_t index, const JsonRef& asked) {
  if (shapes_[index]) return *shapes_[index];
  if (std::find(open_.begin(), open_.end(), index) != open_.end())
    asked.fail("shape " + std::to_string(index) + " is an operand of itself");
  if (open_.size() >= size_t(kDeepestComposite))
    asked.fail("composites are nested more than " + std::to_string(kDeepestComposite) + " deep");
  open_.push_back(index);
  const std::string key = kind_keys(list_[index])[0];
  shapes_[index] = find_kind(key)->read(list_[index][key], *this);
  open_.pop_back();
  return *shapes_[index];
}

std::vector<Shape> ShapeReader::read_all() {
  std::vector<Shape> all;
  all.reserve(list_.size());
  for (size_t k = 0; k < list_.size(); ++k) read(k, list_[k]);
  for (auto& shape : shapes_) all.push_back(std::move(*shape));
  return all;
}

}  // namespace

Check shape_description() { return check_shape; }

std::vector<Shape> read_shapes(const JsonRef& extension, LoadBudget& budget) {
  if (const auto shapes = extension.find("shapes")) budget.take(*shapes, shapes->value().size(), kShapeBytes);
  return ShapeReader(extension, budget).read_all();
}

}  // namespace alhazen
