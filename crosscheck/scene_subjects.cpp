#include "crosscheck/scene_subjects.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>

namespace alhazen::crosscheck {
namespace {

constexpr uint64_t kRaysForEach = 64;
constexpr double kFurthest = 1.8e18;  // what traversal holds
constexpr size_t kTriangleKind = std::variant_size_v<Shape>;

/// One placed object's surfaces: a shape, or the triangles of a mesh.
struct Member {
  uint32_t object;
  uint64_t first;  // number of its first surface in the family
};

size_t triangle_count(const Mesh& mesh) {
  size_t count = 0;
  for (const TriangleMesh& part : mesh.parts) count += part.triangles.size();
  return count;
}

/// A power of two of about an eighth of the box.
double lattice_step(const Bounds3d& box) {
  const double size = max_component(box.upper - box.lower);
  return size > 0 && std::isfinite(size) ? std::exp2(std::floor(std::log2(size / 8))) : 1;
}

/// A step through 0 ... n - 1 that visits all of them, far from one to the next.
uint64_t spreading_stride(uint64_t n) {
  auto stride = uint64_t(double(n) * 0.6180339887498949);
  while (std::gcd(stride, n) != 1) ++stride;
  return stride;
}

Surface surface_of(const Shape& shape) {
  return std::visit([](const auto& s) -> Surface { return s; }, shape);
}

/// The surfaces of some objects, numbered through.
class Selection {
 public:
  Selection(const Geometry& geometry, std::span<const std::string> node_names, const std::vector<uint32_t>& objects)
      : geometry_(&geometry), node_names_(node_names) {
    for (const uint32_t object : objects) {
      members_.push_back({object, count_});
      count_ += is_shape(geometry, object) ? 1 : triangle_count(geometry.meshes[geometry.mesh_instances.mesh_of(object)]);
    }
    if (count_ > 0) stride_ = spreading_stride(count_);
  }

  [[nodiscard]] uint64_t count() const { return count_; }

  /// Passes over triangles that are out of reach.
  [[nodiscard]] Subject subject(uint64_t chunk) const {
    constexpr uint64_t kTries = 64;
    for (uint64_t k = 0; k < kTries; ++k)
      if (std::optional<Subject> found = surface((chunk + k) % count_ * stride_ % count_)) return *found;
    return {.surface = Triangle{}, .world_from_object = {}, .origin = "no triangle within reach"};
  }

 private:
  [[nodiscard]] std::optional<Subject> surface(uint64_t number) const {
    const auto after = std::upper_bound(members_.begin(), members_.end(), number,
                                        [](uint64_t n, const Member& m) { return n < m.first; });
    const Member& member = *(after - 1);
    Subject subject;
    subject.origin = node_label(node_names_, node_of(*geometry_, member.object));
    if (is_shape(*geometry_, member.object)) {
      const ShapeInstance& placed = shape_instance(*geometry_, member.object);
      subject.surface = surface_of(geometry_->shapes[placed.shape]);
      subject.world_from_object = placed.world_from_object;
    } else if (!place_triangle(member.object, number - member.first, subject)) {
      return std::nullopt;
    }
    subject.lattice_step = lattice_step(transform_bounds(subject.world_from_object, bounds_of(subject.surface)));
    return subject;
  }

  bool place_triangle(uint32_t object, uint64_t number, Subject& subject) const {
    const MeshInstance instance = geometry_->mesh_instances[object];
    const auto& parts = geometry_->meshes[instance.mesh].parts;
    size_t part = 0;
    while (number >= parts[part].triangles.size()) number -= parts[part++].triangles.size();
    const Triangle triangle = triangle_of(parts[part], number);
    subject.surface = triangle, subject.world_from_object = instance.world_from_object;
    subject.origin += ", triangle " + std::to_string(number) + " of primitive " + std::to_string(part);
    return is_reachable(triangle, instance.world_from_object);
  }

  const Geometry* geometry_;
  std::span<const std::string> node_names_;
  std::vector<Member> members_;
  uint64_t count_ = 0, stride_ = 0;
};

void add_family(const std::string& name, const Geometry& geometry, std::span<const std::string> node_names,
                const std::vector<uint32_t>& objects, std::vector<Family>& families) {
  const auto selection = std::make_shared<Selection>(geometry, node_names, objects);
  if (selection->count() == 0) return;
  families.push_back(
      {name, [selection](uint64_t chunk, bool, Random&) { return selection->subject(chunk); }, kRaysForEach, true});
}

size_t object_count(const Geometry& geometry) {
  return geometry.mesh_instances.size() + geometry.shape_instances.size();
}

size_t kind_of(const Geometry& geometry, uint32_t object) {
  return is_shape(geometry, object) ? geometry.shapes[shape_instance(geometry, object).shape].index() : kTriangleKind;
}

template <class Wanted>
std::vector<uint32_t> objects_where(const Geometry& geometry, const Wanted& wanted) {
  std::vector<uint32_t> objects;
  for (uint32_t object = 0; object < object_count(geometry); ++object)
    if (wanted(object)) objects.push_back(object);
  return objects;
}

/// By the name or number of a node, else by the name of a mesh; shapes before meshes.
std::vector<uint32_t> objects_named(const Geometry& geometry, std::span<const std::string> node_names,
                                    const std::string& name) {
  const auto by_node = [&](uint32_t object) {
    const uint32_t node = node_of(geometry, object);
    return std::to_string(node) == name || (node < node_names.size() && node_names[node] == name);
  };
  auto objects = objects_where(geometry, [&](uint32_t o) { return is_shape(geometry, o) && by_node(o); });
  if (objects.empty()) objects = objects_where(geometry, by_node);
  if (!objects.empty()) return objects;
  return objects_where(geometry, [&](uint32_t o) {
    return !is_shape(geometry, o) && geometry.meshes[geometry.mesh_instances.mesh_of(o)].name == name;
  });
}

}  // namespace

const char* kind_name(size_t kind) {
  constexpr const char* names[std::variant_size_v<Surface>] = {"sphere",  "cylinder", "disk",      "box",
                                                               "polygon", "quadric",  "composite", "triangle"};
  return names[kind];
}

std::string node_label(std::span<const std::string> node_names, uint32_t node) {
  std::string text = "node " + std::to_string(node);
  if (node >= node_names.size() || node_names[node].empty()) return text;
  text += " '" + node_names[node] + "'";
  for (char& c : text)
    if (uint8_t(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

Triangle triangle_of(const TriangleMesh& part, size_t number) {
  const auto& corners = part.triangles[number];
  const auto at = [&](size_t k) { return Vec3d(part.positions[corners[k]]); };
  return {at(0), at(1), at(2)};
}

bool is_reachable(const Triangle& triangle, const Affine3d& m) {
  const auto within = [](const Vec3d& p) { return is_finite(p) && max_component(abs(p)) < kFurthest; };
  const auto reachable = [&](const Vec3d& p) { return within(p) && within(transform_point(m, p)); };
  return reachable(triangle.a) && reachable(triangle.b) && reachable(triangle.c);
}

std::vector<Family> scene_families(const Geometry& geometry, std::span<const std::string> node_names,
                                   const std::string& wanted) {
  std::vector<Family> families;
  for (size_t kind = 0; kind <= kTriangleKind; ++kind)
    if (wanted == "all" || wanted == kind_name(kind))
      add_family(kind_name(kind), geometry, node_names,
                 objects_where(geometry, [&](uint32_t object) { return kind_of(geometry, object) == kind; }), families);
  if (families.empty() && wanted != "all")
    add_family(wanted, geometry, node_names, objects_named(geometry, node_names, wanted), families);
  return families;
}

std::vector<std::string> scene_family_names(const Geometry& geometry, std::span<const std::string> node_names) {
  std::vector<std::string> names;
  for (const Family& family : scene_families(geometry, node_names, "all")) names.push_back(family.name);
  std::set<std::string> others;
  for (uint32_t object = 0; object < object_count(geometry); ++object) {
    if (const uint32_t node = node_of(geometry, object); node < node_names.size()) others.insert(node_names[node]);
    if (!is_shape(geometry, object)) others.insert(geometry.meshes[geometry.mesh_instances.mesh_of(object)].name);
  }
  others.erase("");
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

}  // namespace alhazen::crosscheck
