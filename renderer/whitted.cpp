#include "renderer/whitted.h"

#include <algorithm>
#include <cmath>

#include "materials/fresnel.h"
#include "materials/metallic_roughness.h"
#include "materials/phong.h"

namespace alhazen {
namespace {

constexpr size_t kWaveLimit = 4096;    // rays traced together; what is left waits, so that memory stays bounded
constexpr size_t kShadowLimit = 8192;  // shadow rays gathered before they are traced

/// One hit being shaded.
struct Shading {
  const SurfacePoint& surface;
  const Material& material;
  Vec3f d, b, n;  // ray direction, back along it, shading normal turned towards b; unit length
  bool enters;    // n of the surface against d
  Rgb weight;     // of the ray, times the surface's coverage
  uint32_t pixel;
  uint16_t depth;
};

class Whitted {
 public:
  Whitted(const Scene& scene, const AcceleratedScene& accelerated, const RenderOptions& options, WaveArena& arena,
          Rgb* radiance, float* background)
      : scene_(scene),
        accelerated_(accelerated),
        options_(options),
        arena_(arena),
        radiance_(radiance),
        background_(background),
        table_(texture_table(scene)) {}

  void run() {
    bool first = true;
    while (arena_.pending.size() > 0) {
      take_wave();
      for (size_t i = 0; i < arena_.current.size(); ++i) ++arena_.rays_by_kind[size_t(arena_.current.kind[i])];
      accelerated_.intersect(arena_.current.rays, first ? Coherence::coherent : Coherence::incoherent, arena_.hits);
      for (size_t i = 0; i < arena_.current.size(); ++i) shade(i);
      trace_shadows(first ? Coherence::coherent : Coherence::incoherent);
      first = false;
    }
  }

 private:
  /// Moves the last rays of `pending` to `current`.
  void take_wave() {
    PathWave &from = arena_.pending, &to = arena_.current;
    if (from.size() <= kWaveLimit) {
      std::swap(from, to);
      from.resize(0);
      return;
    }
    const size_t first = from.size() - kWaveLimit;
    to.resize(0);
    for (size_t i = first; i < from.size(); ++i)
      to.push(from.rays.get(i), from.pixel[i], from.weight[i], from.depth[i], from.kind[i]);
    from.resize(first);
  }

  void shade(size_t i) {
    const PathWave& wave = arena_.current;
    const HitWave& hits = arena_.hits;
    const uint32_t pixel = wave.pixel[i];
    const bool view = wave.kind[i] == RayKind::camera || wave.kind[i] == RayKind::straight;
    if (hits.object[i] == kNone) {
      if (options_.transparent && view)
        background_[pixel] += wave.weight[i].r;  // a product of (1 - alpha): grey
      else
        radiance_[pixel] += wave.weight[i] * scene_.background;
      return;
    }
    const Rayf ray = wave.rays.get(i);
    const SurfacePoint surface =
        surface_point(scene_, ray, {hits.object[i], hits.part[i], hits.primitive[i]}, hits.t[i], hits.u[i], hits.v[i]);
    const Material& material = scene_.materials[surface.material];
    const SurfaceInputs inputs = surface.inputs();
    const float alpha = material.alpha_mode == AlphaMode::blend ? coverage(material, table_, inputs) : 1.0f;
    Vec3f n = shading_normal(surface, material);
    const Vec3f b = -ray.direction;
    const bool enters = dot(n, ray.direction) < 0;
    if (!enters) n = -n;
    const Shading s{surface, material, ray.direction, b, n, enters, wave.weight[i] * alpha, pixel, wave.depth[i]};
    if (alpha < 1) {
      // A texel that is not there at all costs no depth: foliage is made of many of them.
      const uint16_t depth = alpha > 0 ? uint16_t(s.depth + 1) : s.depth;
      spawn_at_depth(s, ray.direction, wave.weight[i] * (1 - alpha), view ? RayKind::straight : wave.kind[i], depth);
    }
    if (alpha == 0) return;
    radiance_[pixel] += s.weight * emission(material, table_, inputs);
    if (material.model == ShadingModel::unlit) return;
    if (material.model == ShadingModel::phong)
      shade_phong(s, phong_bsdf(material, table_, inputs));
    else
      shade_metallic_roughness(s, metallic_roughness_bsdf(material, table_, inputs));
  }

  [[nodiscard]] Vec3f shading_normal(const SurfacePoint& s, const Material& material) const {
    if (!material.normal_texture || !(dot(s.tangent_world, s.tangent_world) > 0)) return s.ns_world;
    const Vec3f m = tangent_space_normal(material, table_, s.inputs());
    const Vec3f t = s.tangent_world, bitangent = cross(s.ns_world, t) * s.bitangent_sign;
    const Vec3f n = normalize(t * m.x + bitangent * m.y + s.ns_world * m.z);
    return is_finite(n) && dot(n, n) > 0 ? n : s.ns_world;
  }

  void shade_phong(const Shading& s, const PhongBsdf& bsdf) {
    radiance_[s.pixel] += s.weight * bsdf.ambient * scene_.ambient;
    add_lights(s, [&](const Vec3f& to_light) { return reflected_light(bsdf, s.n, to_light, s.b); });

    Rgb mirror = bsdf.reflection, through = bsdf.transmission;
    const float eta = s.enters ? 1 / bsdf.ior : bsdf.ior;
    Vec3f refracted;
    const bool passes = max_component(through) > 0 && refract(s.d, s.n, eta, refracted);
    if (bsdf.fresnel) {
      const float f = fresnel_dielectric(std::min(1.0f, dot(s.n, s.b)), eta);
      mirror = mirror * f;
      through = through * (1 - f);
    } else if (!passes) {
      mirror += through;
    }
    spawn(s, reflect(s.d, s.n), s.weight * mirror, RayKind::mirror);
    if (passes) spawn(s, refracted, s.weight * through, RayKind::refracted);
  }

  void shade_metallic_roughness(const Shading& s, const MetallicRoughnessBsdf& bsdf) {
    const float cos_view = std::max(0.0f, dot(s.n, s.b)), share = mirror_share(bsdf.roughness);
    // Diffuse ambient light, and for metal the part of the reflection that no mirror ray stands for.
    const Rgb rough_metal = bsdf.base_color * (bsdf.metallic * (1 - share));
    radiance_[s.pixel] += s.weight * (diffuse_albedo(bsdf) + rough_metal) * scene_.ambient * bsdf.occlusion;
    add_lights(s, [&](const Vec3f& to_light) { return reflected_light(bsdf, s.n, to_light, s.b); });

    const Rgb fresnel = specular_reflectance(bsdf, cos_view);
    Vec3f mirrored = reflect(s.d, s.n);
    // A bumped normal may send the mirror ray below the surface: turn it back to the side that is seen.
    const Vec3f ng = dot(s.surface.ng_world, s.b) < 0 ? -s.surface.ng_world : s.surface.ng_world;
    if (const float below = dot(mirrored, ng); below < 0) mirrored = normalize(mirrored - (2 * below) * ng);
    spawn(s, mirrored, s.weight * fresnel * share, RayKind::mirror);
    const Rgb thin = (Rgb(1.0f) - fresnel) * bsdf.base_color * (bsdf.transmission * (1 - bsdf.metallic));
    spawn(s, s.d, s.weight * thin, RayKind::refracted);  // thin-walled: in and out at once
  }

  void spawn(const Shading& s, const Vec3f& direction, const Rgb& weight, RayKind kind) {
    spawn_at_depth(s, direction, weight, kind, uint16_t(s.depth + 1));
  }

  void spawn_at_depth(const Shading& s, const Vec3f& direction, const Rgb& weight, RayKind kind, uint16_t depth) {
    const float largest = max_component(weight);
    if (int(depth) > options_.max_depth || !(largest >= options_.min_weight) || !(largest > 0)) return;
    Rayf ray{spawn_origin(s.surface, direction), normalize(direction)};
    arena_.pending.push(ray, s.pixel, weight, depth, kind);
  }

  /// Queues one shadow ray for each light whose reflected light is not 0.
  template <class Reflected>
  void add_lights(const Shading& s, const Reflected& reflected) {
    for (const Light& light : scene_.lights) {
      Vec3f to_light;
      float distance = std::numeric_limits<float>::infinity();
      const Rgb arriving = light_at(light, s.surface.p_world, to_light, distance);
      if (!(max_component(arriving) > 0)) continue;
      const Rgb light_to_eye = s.weight * arriving * reflected(to_light);
      if (!(max_component(light_to_eye) > 0)) continue;
      const size_t i = arena_.shadow.size();
      arena_.shadow.resize(i + 1), arena_.shadow_pixel.resize(i + 1), arena_.shadow_light.resize(i + 1);
      Rayf ray{spawn_origin(s.surface, to_light), to_light};
      if (std::isfinite(distance)) {
        // From the shifted origin to the light itself, in units of the segment.
        const Vec3f segment = Vec3f(light.p_world - Vec3d(ray.origin));
        ray.direction = segment, ray.t_max = 1;
      }
      arena_.shadow.set(i, ray);
      arena_.shadow_pixel[i] = s.pixel, arena_.shadow_light[i] = light_to_eye;
      if (i + 1 == kShadowLimit) trace_shadows(Coherence::incoherent);
    }
  }

  /// Colour x intensity x attenuation at a point (KHR_lights_punctual's formulas), and where the light is seen from
  /// there.
  static Rgb light_at(const Light& light, const Vec3d& p_world, Vec3f& to_light, float& distance) {
    if (light.kind == Light::Kind::directional) {
      to_light = Vec3f(-light.direction_world);
      return light.intensity;
    }
    const Vec3d segment = light.p_world - p_world;
    const double squared = dot(segment, segment);
    if (!(squared > 0)) return Rgb(0.0f);
    distance = float(std::sqrt(squared));
    to_light = Vec3f(segment / std::sqrt(squared));
    float factor = 1;
    if (light.attenuated) {
      factor = float(1 / squared);
      if (light.range > 0) factor *= std::clamp(1 - std::pow(distance / light.range, 4.0f), 0.0f, 1.0f);
    }
    if (light.kind == Light::Kind::spot) {
      const float scale = 1 / std::max(0.001f, light.cos_inner - light.cos_outer);
      const float angular =
          std::clamp((float(-dot(light.direction_world, Vec3d(to_light))) - light.cos_outer) * scale, 0.0f, 1.0f);
      factor *= angular * angular;
    }
    return light.intensity * factor;
  }

  void trace_shadows(Coherence coherence) {
    if (arena_.shadow.size() == 0) return;
    arena_.shadow_rays += arena_.shadow.size();
    accelerated_.transmittance(arena_.shadow, coherence, arena_.visible);
    for (size_t i = 0; i < arena_.shadow.size(); ++i)
      radiance_[arena_.shadow_pixel[i]] += arena_.shadow_light[i] * arena_.visible[i];
    arena_.shadow.resize(0), arena_.shadow_pixel.resize(0), arena_.shadow_light.resize(0);
  }

  const Scene& scene_;
  const AcceleratedScene& accelerated_;
  const RenderOptions& options_;
  WaveArena& arena_;
  Rgb* radiance_;
  float* background_;
  TextureTable table_;
};

}  // namespace

void trace_whitted(const Scene& scene, const AcceleratedScene& accelerated, const RenderOptions& options,
                   WaveArena& arena, Rgb* radiance, float* background) {
  Whitted(scene, accelerated, options, arena, radiance, background).run();
}

}  // namespace alhazen
