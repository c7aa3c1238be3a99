#include "materials/phong.h"

namespace alhazen {

PhongBsdf phong_bsdf(const Material& material, const TextureTable& table, const SurfaceInputs& inputs) noexcept {
  const PhongParameters& p = material.phong;
  SurfaceInputs point = inputs;  // the model knows no mipmaps
  point.footprint = 0;
  const auto textured = [&](const Rgb& factor, const TextureUse& use) {
    return factor * inputs.color.rgb * sample(table, use, ColorSpace::srgb, point).rgb;
  };
  return {textured(p.ambient, p.ambient_texture),
          textured(p.diffuse, p.diffuse_texture),
          p.specular,
          p.shininess,
          p.reflection,
          p.transmission,
          p.ior,
          p.fresnel};
}

Rgb reflected_light(const PhongBsdf& bsdf, const Vec3f& n, const Vec3f& s, const Vec3f& b) noexcept {
  const float ns = dot(n, s);
  if (!(ns > 0)) return {};
  const float rb = dot(2 * ns * n - s, b);
  return bsdf.diffuse * ns + (rb > 0 ? bsdf.specular * std::pow(std::min(rb, 1.0f), bsdf.shininess) : Rgb{});
}

PhongRays ray_weights(const PhongBsdf& bsdf, float fresnel, bool passes) noexcept {
  if (bsdf.fresnel) return {bsdf.reflection * fresnel, bsdf.transmission * (1 - fresnel)};
  return passes ? PhongRays{bsdf.reflection, bsdf.transmission} : PhongRays{bsdf.reflection + bsdf.transmission, {}};
}

}  // namespace alhazen
