#include "loaders/gltf_instancing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
namespace alhazen {
namespace {

struct Attribute {
  const char* name;
  size_t components;
};
constexpr std::array<Attribute, 3> kAttributes{{{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}}};

/// The numbers of an attribute for some instances; none where there is no such.
std::vector<float> values_of(const JsonRef& attributes, const char* name, const GltfBuffers& buffers,
                             std::span<const uint32_t> instances) {
  const auto at = attributes.find(name);
  if (!at) return {};
  std::vector<float> values = floats(buffers.accessor(at->as<int>()), instances);
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    at->fail("expected finite numbers, the accessor holds others");
  return values;
}

/// The numbers of some instances, as an array of their own.
InstanceArray read_places(const JsonRef& attributes, const GltfBuffers& buffers, std::span<const uint32_t> instances,
                          const InstanceArray& below) {
  InstanceArray places{.mesh = below.mesh,
                       .node = below.node,
                       .world_from_node = below.world_from_node,
                       .count = uint32_t(instances.size())};
  const auto values = [&](const char* name) { return values_of(attributes, name, buffers, instances); };
  const std::vector<float> t = values("TRANSLATION"), q = values("ROTATION"), s = values("SCALE");
  for (size_t i = 0; i < t.size(); i += 3) places.translations.push_back({t[i], t[i + 1], t[i + 2]});
  for (size_t i = 0; i < q.size(); i += 4) places.rotations.push_back({q[i], q[i + 1], q[i + 2], q[i + 3]});
  for (size_t i = 0; i < s.size(); i += 3) places.scales.push_back({s[i], s[i + 1], s[i + 2]});
  return places;
}

/// `count`: of all that may come.
void append_invertible(const InstanceArray& places, uint64_t count, InstanceArray& array) {
  const auto append = [count](const auto& from, size_t k, auto& to) {
    if (from.empty()) return;
    to.reserve(count);
    to.push_back(from[k]);
  };
  for (size_t k = 0; k < places.count; ++k) {
    if (!is_invertible(world_from_object(places, k))) continue;
    append(places.translations, k, array.translations);
    append(places.rotations, k, array.rotations);
    append(places.scales, k, array.scales);
    ++array.count;
  }
}

}  // namespace

uint64_t instance_count(const JsonRef& r, const GltfBuffers& buffers) {
  uint64_t count = 0;
  for (const Attribute& attribute : kAttributes) {
    const auto at = r["attributes"].find(attribute.name);
    if (!at) continue;
    const AccessorView& accessor = buffers.accessor(at->as<int>());
    if (accessor.components != attribute.components || accessor.rows != attribute.components)
      at->expected("an accessor of " + std::to_string(attribute.components) + " components");
    if (count != 0 && accessor.count != count)
      at->fail("expected an accessor of " + std::to_string(count) + " elements as the others have, it has " +
               std::to_string(accessor.count));
    count = accessor.count;
  }
  return count;
}

void read_instances(const JsonRef& r, const GltfBuffers& buffers, InstanceArray& array) {
  constexpr uint64_t kAtOnce = 4096;  // their numbers take little besides the instances themselves
  const JsonRef attributes = r["attributes"];
  const uint64_t count = instance_count(r, buffers);
  std::vector<uint32_t> instances;
  for (uint64_t first = 0; first < count; first += kAtOnce) {
    instances.resize(std::min(kAtOnce, count - first));
    std::iota(instances.begin(), instances.end(), uint32_t(first));
    append_invertible(read_places(attributes, buffers, instances, array), count, array);
  }
}

}  // namespace alhazen
