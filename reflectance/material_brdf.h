// A scene's material as a BRDF: the renderer's own functions, asked for all directions.
#pragma once

#include <memory>

#include "materials/metallic_roughness.h"
#include "materials/phong.h"
#include "reflectance/subject.h"
#include "renderer/scene.h"

namespace alhazen {

/// The material at a point whose texture coordinates, of every set, are `uv`. Normal textures are left out: the BRDF is
/// that of the surface about its own normal. The course's Phong model is a BRDF once it is said what its light of 1 is:
/// here the light that a white diffuse surface facing it shows as 1, pi of irradiance, so that diffuseFactor is an
/// albedo as ambientFactor is. Throws UsageError for an unlit material, which reflects nothing.
[[nodiscard]] Subject material_subject(const Scene& scene, uint32_t material, Vec2f uv);

/// One model by itself, as `material_subject` shows it; `name` is left empty. `angle`: of anisotropy, in radians.
[[nodiscard]] Subject phong_subject(const PhongBsdf& bsdf);
[[nodiscard]] Subject layered_subject(const MetallicRoughnessBsdf& bsdf, float angle);

/// A measured surface, named after its file.
[[nodiscard]] Subject measured_subject(std::shared_ptr<const MeasuredBrdf> brdf, float scale = 1);

}  // namespace alhazen
