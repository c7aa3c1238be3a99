#include "renderer/media.h"

#include <algorithm>
#include <cmath>

namespace alhazen {
namespace {

int priority(const Material& material) { return material.model == ShadingModel::phong ? material.phong.priority : 0; }

/// For red, green and blue light: at the ends and the middle of the spread that KHR_materials_dispersion states.
Rgb ior(const Material& material) {
  if (material.model == ShadingModel::phong) return Rgb{material.phong.ior};
  const float half_spread = (material.ior - 1) * 0.025f * material.volume.dispersion;
  return {material.ior - half_spread, material.ior, material.ior + half_spread};
}

/// The material that rules; kNone outside of all bodies.
uint32_t ruler(const Media& media, const std::vector<Material>& materials) {
  uint32_t best = kNone;
  for (uint8_t k = 0; k < media.count; ++k)
    if (best == kNone || priority(materials[media.material[k]]) >= priority(materials[best])) best = media.material[k];
  return best;
}

void add(Media& media, uint32_t material) {
  if (media.count == Media::kMost) {
    std::copy(media.material.begin() + 1, media.material.end(), media.material.begin());
    --media.count;
  }
  media.material[media.count++] = material;
}

/// The last one of that material; false where there is none.
bool remove(Media& media, uint32_t material) {
  for (int k = media.count - 1; k >= 0; --k) {
    if (media.material[size_t(k)] != material) continue;
    std::copy(media.material.begin() + k + 1, media.material.begin() + media.count, media.material.begin() + k);
    --media.count;
    return true;
  }
  return false;
}

}  // namespace

bool bounds_body(const Material& material) noexcept {
  switch (material.model) {
    case ShadingModel::phong:
      return material.phong.takes_part;
    case ShadingModel::metallic_roughness:
      return material.volume.is_body() && material.transmission > 0;
    case ShadingModel::unlit:
    case ShadingModel::measured:
      return false;
  }
  return false;
}

Boundary cross_boundary(const Media& before, uint32_t material, bool enters,
                        const std::vector<Material>& materials) noexcept {
  Boundary boundary;
  Media inside = before;
  boundary.after = before;
  if (enters)
    add(boundary.after, material);
  else if (!remove(boundary.after, material))
    add(inside, material);
  const uint32_t from = ruler(inside, materials), to = ruler(boundary.after, materials);
  if (from != kNone) boundary.ior_before = ior(materials[from]);
  if (to != kNone) boundary.ior_after = ior(materials[to]);
  boundary.seen = from != to;
  return boundary;
}

Rgb transmittance(const Media& media, const std::vector<Material>& materials, float distance) noexcept {
  const uint32_t medium = ruler(media, materials);
  if (medium == kNone || materials[medium].model == ShadingModel::phong) return Rgb{1.0f};
  const Rgb sigma = attenuation_per_metre(materials[medium].volume);
  return {std::exp(-sigma.r * distance), std::exp(-sigma.g * distance), std::exp(-sigma.b * distance)};
}

}  // namespace alhazen
