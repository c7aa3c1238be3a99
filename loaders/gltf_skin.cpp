#include "loaders/gltf_skin.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace alhazen {
namespace {

std::vector<Affine3d> read_matrices(const JsonRef& r, const GltfBuffers& buffers, size_t count) {
  const AccessorView& accessor = buffers.accessor(r.as<int>());
  if (accessor.components != 16) r.expected("an accessor of type MAT4");
  if (accessor.count < count)
    r.fail("expected a matrix for each of " + std::to_string(count) + " joints, the accessor has " +
           std::to_string(accessor.count));
  std::vector<uint32_t> elements(count);
  std::iota(elements.begin(), elements.end(), 0u);
  const std::vector<float> m = floats(accessor, elements);
  if (!std::all_of(m.begin(), m.end(), [](float v) { return std::isfinite(v); }))
    r.fail("expected finite numbers, the accessor holds others");
  std::vector<Affine3d> maps;
  for (size_t i = 0; i < m.size(); i += 16) {
    const auto column = [&](size_t k) { return Vec3d(m[i + 4 * k], m[i + 4 * k + 1], m[i + 4 * k + 2]); };
    maps.emplace_back(column(0), column(1), column(2), column(3));
  }
  return maps;
}

}  // namespace

std::vector<Skin> read_skins(const GltfSource& source, const GltfBuffers& buffers) {
  std::vector<Skin> skins;
  for (const JsonRef& r : source.root().elements("skins")) {
    Skin skin{r["joints"].as<std::vector<uint32_t>>(), {}};
    if (const auto matrices = r.find("inverseBindMatrices"))
      skin.joint_from_rest = read_matrices(*matrices, buffers, skin.joints.size());
    else
      skin.joint_from_rest.resize(skin.joints.size());
    skins.push_back(std::move(skin));
  }
  return skins;
}

std::vector<Affine3d> world_from_rest(const Skin& skin, std::span<const Affine3d> world_from_node) {
  std::vector<Affine3d> maps;
  maps.reserve(skin.joints.size());
  for (size_t i = 0; i < skin.joints.size(); ++i)
    maps.push_back(world_from_node[skin.joints[i]] * skin.joint_from_rest[i]);
  return maps;
}

}  // namespace alhazen
