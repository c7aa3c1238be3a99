#include "renderer/whitted.h"

#include <algorithm>
#include <cmath>

#include "materials/fresnel.h"
#include "materials/metallic_roughness.h"
#include "materials/phong.h"
#include "renderer/moving.h"
#include "renderer/trace_observer.h"

namespace alhazen {
namespace {

constexpr size_t kWaveLimit = 4096;    // rays traced together; what is left waits, so that memory stays bounded
constexpr size_t kShadowLimit = 8192;  // shadow rays gathered before they are traced

/// One hit being shaded.
struct Shading {
  const HitIds& ids;
  const SurfacePoint& surface;
  const Material& material;
  Vec3f d, b, n;      // ray direction, back along it, shading normal turned towards b; unit length
  bool enters;        // n of the surface against d
  Rgb weight;         // of the ray, times the surface's coverage
  const Path& path;   // of the ray
  Cone cone;          // of the ray, at the hit
  Boundary boundary;  // where the surface bounds a body
};

/// A direction in tangent space brought to the world.
Vec3f world_from_tangent(const SurfacePoint& surface, const Vec3f& m) {
  const Vec3f t = surface.tangent_world, bitangent = cross(surface.ns_world, t) * surface.bitangent_sign;
  return normalize(t * m.x + bitangent * m.y + surface.ns_world * m.z);
}

bool has_tangent(const SurfacePoint& surface) { return dot(surface.tangent_world, surface.tangent_world) > 0; }

// What is left of them when an observer asks for the highlights alone.

PhongBsdf without_diffuse(PhongBsdf bsdf) {
  bsdf.diffuse = Rgb(0.0f);
  return bsdf;
}

MetallicRoughnessBsdf without_diffuse(MetallicRoughnessBsdf bsdf) {
  bsdf.transmission = 1;  // takes its share of the diffuse light alone
  return bsdf;
}

MeasuredBsdf without_diffuse(MeasuredBsdf bsdf) {
  bsdf.highlight_only = true;
  return bsdf;
}

/// `observed`: whether the arena's observer is told. Nothing of it is left in the code where not.
template <bool observed>
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
      for (size_t i = 0; i < arena_.current.size(); ++i) ++arena_.rays_by_kind[size_t(arena_.current.paths[i].kind)];
      set_times(arena_.current.rays, [&](size_t i) { return arena_.current.paths[i].pixel; });
      log(first ? WaveKind::camera : WaveKind::bounced, arena_.current.rays);
      arena_.clock.enter(Phase::traversal);
      accelerated_.intersect(arena_.current.rays, first ? Coherence::coherent : Coherence::incoherent, arena_.hits);
      arena_.clock.enter(Phase::shading);
      for (size_t i = 0; i < arena_.current.size(); ++i) {
        tell([&](TraceObserver& observer) { observer.look_at(i); });
        shade(i);
      }
      trace_shadows(first ? Coherence::coherent : Coherence::incoherent);
      first = false;
    }
  }

 private:
  /// Of the shutter, when all rays of the sample at hand are traced.
  [[nodiscard]] float time_of(uint32_t pixel) const {
    return arena_.time_of_pixel.size() > 0 ? arena_.time_of_pixel[pixel] : 0;
  }

  template <class PixelOf>
  void set_times(RayWave& rays, const PixelOf& pixel_of) const {
    if (arena_.time_of_pixel.size() == 0) return;
    rays.time.resize(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) rays.time[i] = time_of(pixel_of(i));
  }

  void log(WaveKind kind, const RayWave& rays) {
    if (arena_.log && rays.size() > 0) arena_.log->push_back(logged(kind, rays));
  }

  template <class Event>
  void tell(const Event& event) {
    if constexpr (observed) event(*arena_.observer);
  }

  /// Adds light to a path's pixel.
  void add(const Path& path, LightTerm term, const Rgb& light) {
    radiance_[path.pixel] += light;
    tell([&](TraceObserver& observer) { observer.add(term, light); });
  }

  /// Moves the last rays of `pending` to `current`.
  void take_wave() {
    PathWave &from = arena_.pending, &to = arena_.current;
    const size_t first = from.size() <= kWaveLimit ? 0 : from.size() - kWaveLimit;
    tell([&](TraceObserver& observer) { observer.take_wave(first); });
    if (first == 0) {
      std::swap(from, to);
      from.resize(0);
      return;
    }
    to.resize(0);
    for (size_t i = first; i < from.size(); ++i) to.push(from.rays.get(i), from.paths[i]);
    from.resize(first);
  }

  void shade(size_t i) {
    const Path& path = arena_.current.paths[i];
    const HitWave& hits = arena_.hits;
    const Rayf ray = arena_.current.rays.get(i);
    const bool view = path.kind == RayKind::camera || path.kind == RayKind::straight;
    if (hits.object[i] == kNone) {
      if (!options_.transparent || !view) return add_sky(path, ray.direction);
      background_[path.pixel] += path.weight.r;  // a product of (1 - alpha): grey
      return tell([&](TraceObserver& observer) { observer.uncover(path.weight.r); });
    }
    const HitIds ids{hits.object[i], hits.part[i], hits.primitive[i]};
    SurfacePoint surface = surface_point(scene_, ray, ids, hits.t[i], hits.u[i], hits.v[i], time_of(path.pixel));
    const Cone cone = path.cone.at(hits.t[i]);
    // A slanted surface shows more of itself along one axis: the mean of both, for mip levels have no direction.
    surface.footprint = cone.width / std::sqrt(std::max(1e-3f, std::abs(dot(surface.ng_world, ray.direction))));
    const Material& material = scene_.materials[surface.material];
    if (!scene_.images.empty() && material.model != ShadingModel::phong)  // which knows no mipmaps
      measure_shape_uvs(scene_, ids, surface.footprint, time_of(path.pixel), surface);
    const SurfaceInputs inputs = surface.inputs();
    const float alpha = material.alpha_mode == AlphaMode::blend ? coverage(material, table_, inputs) : 1.0f;
    const Rgb arriving =
        path.media.count > 0 ? path.weight * transmittance(path.media, scene_.materials, hits.t[i]) : path.weight;
    Vec3f n = shading_normal(surface, material.normal_texture, material.normal_scale);
    const bool enters = dot(n, ray.direction) < 0;
    if (!enters) n = -n;
    Shading s{ids, surface, material, ray.direction, -ray.direction, n, enters, arriving * alpha, path, cone, {}};
    tell([&](TraceObserver& observer) { observer.hit({ids, hits.t[i], surface, n, enters, alpha, arriving}); });
    if (bounds_body(material)) {
      s.boundary =
          cross_boundary(path.media, surface.material, dot(surface.ng_world, ray.direction) < 0, scene_.materials);
      if (!s.boundary.seen) {
        tell([&](TraceObserver& observer) { observer.pass_unnoticed(); });
        return spawn_as(s, ray.direction,
                        {path.pixel, arriving, path.depth, path.kind, s.boundary.after, cone, path.roughness});
      }
    }
    if (alpha < 1) {
      // A texel that is not there at all costs no depth: foliage is made of many of them.
      const uint16_t depth = alpha > 0 ? uint16_t(path.depth + 1) : path.depth;
      spawn_as(s, ray.direction,
               {path.pixel, arriving * (1 - alpha), depth, view ? RayKind::straight : path.kind, path.media, cone,
                path.roughness});
    }
    if (alpha == 0) return;
    const Rgb emitted = s.weight * emission(material, table_, inputs);
    switch (material.model) {
      case ShadingModel::unlit:
        add(path, LightTerm::emission, emitted);
        break;
      case ShadingModel::phong:
        add(path, LightTerm::emission, emitted);
        shade_phong(s, phong_bsdf(material, table_, inputs));
        break;
      case ShadingModel::measured:
        add(path, LightTerm::emission, emitted);
        shade_measured(s, measured_bsdf(scene_, material));
        break;
      case ShadingModel::metallic_roughness:
        shade_metallic_roughness(s, metallic_roughness_bsdf(material, table_, inputs, relative_ior(s)), emitted);
    }
  }

  /// What a ray sees that leaves the scene.
  void add_sky(const Path& path, const Vec3f& direction) {
    if (sees_background(path)) return add(path, LightTerm::background, path.weight * scene_.background);
    add(path, LightTerm::environment,
        path.weight * environment_radiance(*scene_.environment, direction, path.roughness));
  }

  [[nodiscard]] bool sees_background(const Path& path) const {
    if (!scene_.environment) return true;
    const bool view = path.kind == RayKind::camera || path.kind == RayKind::straight;
    return scene_.environment->seen ? view && scene_.has_background : path.kind != RayKind::mirror;
  }

  /// What a white Lambertian surface reflects of the light without a place.
  [[nodiscard]] Rgb ambient_light(const Vec3f& n) const {
    return scene_.environment ? scene_.ambient + environment_diffuse(*scene_.environment, n) : scene_.ambient;
  }

  /// Of what lies beyond the surface to what lies before it.
  static float relative_ior(const Shading& s) {
    return bounds_body(s.material) ? s.boundary.ior_after.g / s.boundary.ior_before.g : s.material.ior;
  }

  [[nodiscard]] Vec3f shading_normal(const SurfacePoint& s, const TextureUse& texture, float scale) const {
    if (!texture || !has_tangent(s)) return s.ns_world;
    const Vec3f n = world_from_tangent(s, tangent_space_normal(texture, scale, table_, s.inputs()));
    return is_finite(n) && dot(n, n) > 0 ? n : s.ns_world;
  }

  void shade_phong(const Shading& s, const PhongBsdf& bsdf) {
    add(s.path, LightTerm::ambient, s.weight * bsdf.ambient * ambient_light(s.n));
    const auto reflected = [&](const PhongBsdf& of, const Vec3f& to_light) {
      return reflected_light(of, s.n, to_light, s.b);
    };
    add_lights(s, bsdf, reflected);

    const bool body = bounds_body(s.material);
    const float eta = body ? s.boundary.ior_before.g / s.boundary.ior_after.g : s.enters ? 1 / bsdf.ior : bsdf.ior;
    Vec3f refracted;
    const bool transmits = max_component(bsdf.transmission) > 0;
    const bool passes = transmits && refract(s.d, s.n, eta, refracted);
    const float f = bsdf.fresnel ? fresnel_dielectric(std::min(1.0f, dot(s.n, s.b)), eta) : 0.0f;
    if (transmits) tell([&](TraceObserver& observer) { observer.part(phong_interface(s, bsdf, f, !passes)); });
    const PhongRays rays = ray_weights(bsdf, f, passes);
    spawn(s, reflect(s.d, s.n), s.weight * rays.mirrored, RayKind::mirror, s.path.media);
    if (passes)
      spawn(s, refracted, s.weight * rays.refracted, RayKind::refracted, body ? s.boundary.after : s.path.media, 0,
            eta);
  }

  static Interface phong_interface(const Shading& s, const PhongBsdf& bsdf, float fresnel, bool total) {
    Interface interface { s.boundary.ior_before, s.boundary.ior_after, Rgb(fresnel), bsdf.fresnel, total };
    if (!bounds_body(s.material)) (s.enters ? interface.ior_after : interface.ior_before) = Rgb(bsdf.ior);
    return interface;
  }

  /// Light without a place meets the table as it meets glTF's surfaces: a diffuse part, and a lobe about the mirror
  /// direction, whose roughness says how much of it one mirror ray stands for.
  void shade_measured(const Shading& s, const MeasuredBsdf& bsdf) {
    const MeasuredAlbedo albedo = measured_albedo(bsdf, dot(s.n, s.b));
    const float roughness = bsdf.brdf->roughness, share = mirror_share(roughness);
    const Vec3f mirrored = reflect(s.d, s.n);
    const Rgb ambient =
        albedo.diffuse * ambient_light(s.n) + albedo.highlight * (1 - share) * blurred(mirrored, roughness);
    add(s.path, LightTerm::ambient, s.weight * ambient);
    add_lights(s, bsdf,
               [&](const MeasuredBsdf& of, const Vec3f& to_light) { return reflected_light(of, s.n, to_light, s.b); });
    spawn(s, above_surface(s, mirrored), s.weight * albedo.highlight * share, RayKind::mirror, s.path.media, roughness);
  }

  void shade_metallic_roughness(const Shading& s, const MetallicRoughnessBsdf& bsdf, const Rgb& emitted) {
    const LayerFrames frames = layer_frames(s, bsdf);
    const float share = mirror_share(bsdf.roughness), coat_share = mirror_share(bsdf.clearcoat_roughness);
    const float coat = coat_reflectance(bsdf, frames.coat_n, s.b);
    const float left = layers_transmittance(bsdf, frames, s.b);
    add(s.path, LightTerm::emission, emitted * (1 - coat));
    const DiffuseAlbedo diffuse = diffuse_albedo(bsdf, frames, s.b);
    Rgb ambient = diffuse.front * ambient_light(s.n);
    if (bsdf.diffuse_transmission > 0) ambient += diffuse.back * ambient_light(-s.n);
    // The part of the reflections that no mirror ray stands for.
    ambient += rough_reflection(s, bsdf) * (left * (1 - share));
    if (coat > 0) ambient += blurred(reflect(s.d, frames.coat_n), bsdf.clearcoat_roughness) * (coat * (1 - coat_share));
    add(s.path, LightTerm::ambient, s.weight * ambient * bsdf.occlusion);
    add_lights(s, bsdf, [&](const MetallicRoughnessBsdf& of, const Vec3f& to_light) {
      return reflected_light(of, frames, to_light, s.b);
    });

    const Transmission passing = transmission(s, bsdf);
    tell([&](TraceObserver& observer) {
      observer.part({s.boundary.ior_before, s.boundary.ior_after, passing.fresnel, true, !passing.passes});
    });
    const Rgb through = (Rgb(1.0f) - passing.fresnel) * bsdf.base_color;
    spawn(s, above_surface(s, reflect(s.d, frames.coat_n)), s.weight * (coat * coat_share), RayKind::mirror,
          s.path.media, bsdf.clearcoat_roughness);
    spawn(s, above_surface(s, reflect(s.d, s.n)), s.weight * passing.fresnel * (left * share), RayKind::mirror,
          s.path.media, bsdf.roughness);
    spawn_transmitted(s, through * (left * bsdf.transmission * (1 - bsdf.metallic)), passing, bsdf.roughness);
  }

  /// What a rough surface reflects of the environment; without one, of the ambient light, and then metals only: they
  /// have no diffuse light to be seen by.
  [[nodiscard]] Rgb rough_reflection(const Shading& s, const MetallicRoughnessBsdf& bsdf) const {
    if (!scene_.environment) return bsdf.base_color * bsdf.metallic * scene_.ambient;
    return specular_albedo(bsdf, std::max(0.0f, dot(s.n, s.b))) * blurred(reflect(s.d, s.n), bsdf.roughness);
  }

  [[nodiscard]] Rgb blurred(const Vec3f& direction, float roughness) const {
    return scene_.environment ? environment_radiance(*scene_.environment, direction, roughness) : scene_.ambient;
  }

  [[nodiscard]] LayerFrames layer_frames(const Shading& s, const MetallicRoughnessBsdf& bsdf) const {
    LayerFrames frames{ShadingFrame{{}, {}, s.n}, s.n};
    if (bsdf.clearcoat > 0) {
      const Clearcoat& coat = s.material.clearcoat;
      const Vec3f n = shading_normal(s.surface, coat.normal_texture, coat.normal_scale);
      frames.coat_n = dot(n, s.b) < 0 ? -n : n;
    }
    if (bsdf.anisotropy > 0 && has_tangent(s.surface)) {
      const float angle = anisotropy_angle(s.material, table_, s.surface.inputs());
      const Vec3f along = world_from_tangent(s.surface, {std::cos(angle), std::sin(angle), 0});
      frames.base.t = normalize(along - s.n * dot(s.n, along));
      frames.base.b = cross(s.n, frames.base.t);
    } else if (bsdf.anisotropy > 0) {
      frames.base = frame_about(s.n);
    }
    return frames;
  }

  /// A bumped normal may send the mirror ray below the surface: turned back to the side that is seen.
  static Vec3f above_surface(const Shading& s, const Vec3f& mirrored) {
    const Vec3f ng = dot(s.surface.ng_world, s.b) < 0 ? -s.surface.ng_world : s.surface.ng_world;
    const float below = dot(mirrored, ng);
    return below < 0 ? normalize(mirrored - (2 * below) * ng) : mirrored;
  }

  /// Specular light at the base: what is reflected, and where the rest goes.
  struct Transmission {
    Rgb fresnel;
    bool passes = true;
    Vec3f direction;
    Media media;
    float eta = 1;
  };

  /// For green light, or white light that is not dispersed.
  static Transmission transmission(const Shading& s, const MetallicRoughnessBsdf& bsdf) {
    const float cos_view = std::max(0.0f, dot(s.n, s.b));
    // Thin-walled: in and out at once.
    if (!bounds_body(s.material)) return {specular_reflectance(bsdf, cos_view), true, s.d, s.path.media, 1};
    Transmission t{.fresnel = Rgb{1.0f}, .passes = false, .direction = s.d, .media = s.boundary.after};
    t.eta = s.boundary.ior_before.g / s.boundary.ior_after.g;
    t.passes = refract(s.d, s.n, t.eta, t.direction);
    // Schlick's cosine is that on the side of the lower index.
    const bool to_thinner = s.boundary.ior_before.g > s.boundary.ior_after.g;
    if (t.passes) t.fresnel = specular_reflectance(bsdf, to_thinner ? -dot(t.direction, s.n) : cos_view);
    return t;
  }

  void spawn_transmitted(const Shading& s, const Rgb& share, const Transmission& passing, float roughness) {
    const Rgb &before = s.boundary.ior_before, &after = s.boundary.ior_after;
    if (before.r == before.b && after.r == after.b) {
      if (passing.passes)
        spawn(s, passing.direction, s.weight * share, RayKind::refracted, passing.media, roughness, passing.eta);
      return;
    }
    // A ray for each of red, green and blue; the colours of a ray that was split before go on alone.
    const auto spawn_color = [&](float eta, const Rgb& color) {
      Vec3f refracted;
      if (refract(s.d, s.n, eta, refracted))
        spawn(s, refracted, s.weight * share * color, RayKind::refracted, passing.media, roughness, eta);
    };
    spawn_color(before.r / after.r, {1, 0, 0});
    spawn_color(before.g / after.g, {0, 1, 0});
    spawn_color(before.b / after.b, {0, 0, 1});
  }

  /// `eta`: the index before the surface to that beyond it, of a ray that is refracted.
  void spawn(const Shading& s, const Vec3f& direction, const Rgb& weight, RayKind kind, const Media& media,
             float roughness = 0, float eta = 1) {
    if (!(max_component(weight) > 0)) return;
    const float blur = std::min(1.0f, std::hypot(s.path.roughness, roughness));
    const Cone cone = cone_of(s, direction, eta);
    spawn_as(s, direction, {s.path.pixel, weight, uint16_t(s.path.depth + 1), kind, media, cone, blur});
  }

  /// Cones serve textures alone, so that a scene without any does not pay for the curvature.
  [[nodiscard]] Cone cone_of(const Shading& s, const Vec3f& direction, float eta) const {
    if (scene_.images.empty()) return s.cone;
    const float outward = mean_curvature(scene_, s.ids, s.surface, s.cone.width, time_of(s.path.pixel));
    return deflected(s.cone, s.d, s.n, direction, eta, dot(s.surface.ns_world, s.d) < 0 ? outward : -outward);
  }

  void spawn_as(const Shading& s, const Vec3f& direction, const Path& path) {
    const float largest = max_component(path.weight);
    const bool deep = int(path.depth) > options_.max_depth;
    if (deep || !(largest >= options_.min_weight) || !(largest > 0))
      return tell_spawn(s, direction, path, deep ? SpawnOutcome::depth_limit : SpawnOutcome::weight_limit);
    arena_.pending.push({spawn_origin(s.surface, direction), normalize(direction)}, path);
    tell_spawn(s, direction, path, SpawnOutcome::traced);
  }

  void tell_spawn(const Shading& s, const Vec3f& direction, const Path& path, SpawnOutcome outcome) {
    tell([&](TraceObserver& observer) {
      observer.spawn({spawn_origin(s.surface, direction), normalize(direction)}, path, outcome);
    });
  }

  /// Queues one shadow ray for each light whose reflected light is not 0; `reflected(bsdf, to_light)` says how much.
  template <class Bsdf, class Reflected>
  void add_lights(const Shading& s, const Bsdf& bsdf, const Reflected& reflected) {
    for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
      const Light& light = scene_.lights[i];
      if (light.track.empty())
        add_light(s, i, light, bsdf, reflected);
      else
        add_light(s, i, at_time(light.track, time_of(s.path.pixel)), bsdf, reflected);
    }
  }

  /// `light`: that of the index, as it is at the ray's time.
  template <class Bsdf, class Reflected>
  void add_light(const Shading& s, uint32_t index, const Light& light, const Bsdf& bsdf, const Reflected& reflected) {
    Vec3f to_light;
    float distance = std::numeric_limits<float>::infinity();
    const Rgb arriving = light_at(light, s.surface.p_world, to_light, distance);
    if (!(max_component(arriving) > 0)) return;
    const Rgb light_to_eye = s.weight * arriving * reflected(bsdf, to_light);
    if (!(max_component(light_to_eye) > 0)) return;
    const size_t i = arena_.shadow.size();
    arena_.shadow.resize(i + 1), arena_.shadow_pixel.resize(i + 1), arena_.shadow_light.resize(i + 1);
    Rayf ray{spawn_origin(s.surface, to_light), to_light};
    if (std::isfinite(distance)) {
      // From the shifted origin to the light itself, in units of the segment.
      const Vec3f segment = Vec3f(light.p_world - Vec3d(ray.origin));
      ray.direction = segment, ray.t_max = 1;
    }
    arena_.shadow.set(i, ray);
    arena_.shadow_pixel[i] = s.path.pixel, arena_.shadow_light[i] = light_to_eye;
    tell([&](TraceObserver& observer) {
      const Rgb all = reflected(bsdf, to_light), specular = reflected(without_diffuse(bsdf), to_light);
      observer.ask({index, ray, distance, arriving, s.weight, all - specular, specular});
    });
    if (i + 1 == kShadowLimit) trace_shadows(Coherence::incoherent);
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
    set_times(arena_.shadow, [&](size_t i) { return arena_.shadow_pixel[i]; });
    log(coherence == Coherence::coherent ? WaveKind::camera_shadow : WaveKind::bounced_shadow, arena_.shadow);
    arena_.clock.enter(Phase::traversal);
    accelerated_.transmittance(arena_.shadow, coherence, arena_.visible);
    arena_.clock.enter(Phase::shading);
    for (size_t i = 0; i < arena_.shadow.size(); ++i) {
      const Rgb light = arena_.shadow_light[i] * arena_.visible[i];
      radiance_[arena_.shadow_pixel[i]] += light;
      tell([&](TraceObserver& observer) { observer.answer(i, arena_.visible[i], light); });
    }
    tell([&](TraceObserver& observer) { observer.answered(); });
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
  if (arena.observer)
    Whitted<true>(scene, accelerated, options, arena, radiance, background).run();
  else
    Whitted<false>(scene, accelerated, options, arena, radiance, background).run();
}

}  // namespace alhazen
