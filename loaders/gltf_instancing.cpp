#include "loaders/gltf_instancing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "loaders/gltf_transform.h"

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

std::vector<Affine3f> read_instances(const JsonRef& r, const GltfBuffers& buffers, uint64_t first, uint64_t count) {
  const JsonRef attributes = r["attributes"];
  std::vector<uint32_t> instances(count);
  std::iota(instances.begin(), instances.end(), uint32_t(first));
  const auto values = [&](const char* name) { return values_of(attributes, name, buffers, instances); };
  const std::vector<float> t = values("TRANSLATION"), q = values("ROTATION"), s = values("SCALE");
  std::vector<Affine3f> maps(count);
  for (size_t i = 0; i < maps.size(); ++i) {
    std::array<double, 4> rotation{0, 0, 0, 1};
    if (!q.empty()) rotation = {q[4 * i], q[4 * i + 1], q[4 * i + 2], q[4 * i + 3]};
    if (rotation == std::array<double, 4>{}) rotation[3] = 1;
    const Vec3d scale = s.empty() ? Vec3d{1, 1, 1} : Vec3d(s[3 * i], s[3 * i + 1], s[3 * i + 2]);
    maps[i] = Affine3f(rotate_scale(rotation, scale));
    if (!t.empty()) maps[i].origin = {t[3 * i], t[3 * i + 1], t[3 * i + 2]};
  }
  return maps;
}

}  // namespace alhazen
