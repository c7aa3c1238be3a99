#include "renderer/hit_shading.h"

#include <algorithm>
#include <cmath>

#include "materials/fresnel.h"
#include "materials/metallic_roughness.h"
#include "materials/phong.h"
#include "renderer/light.h"
#include "renderer/moving.h"
#include "renderer/pixel_sink.h"
#include "renderer/shading_terms.h"

namespace alhazen {
namespace {

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

template <bool observed>
class HitShader {
 public:
  HitShader(const Scene& scene, const RenderOptions& options, const PixelSink<observed>& sink)
      : scene_(scene), options_(options), arena_(sink.arena), sink_(sink), table_(texture_table(scene)) {}

  void shade(size_t i) {
    const Path path = arena_.current.paths[i];
    const HitWave& hits = arena_.hits;
    const Rayf ray = arena_.current.rays.get(i);
    const HitIds ids{hits.object[i], hits.part[i], hits.primitive[i]};
    arena_.clock.enter_part(Phase::surface_points);
    SurfacePoint surface = surface_point(scene_, ray, ids, hits.t[i], hits.u[i], hits.v[i], arena_.time_of(path.pixel));
    const Cone cone = path.cone.at(hits.t[i]);
    surface.footprint = footprint(cone.width, surface.ng_world, ray.direction);
    const Material& material = scene_.materials[surface.material];
    if (!scene_.images.empty() && material.model != ShadingModel::phong)  // which knows no mipmaps
      measure_shape_uvs(scene_, ids, surface.footprint, arena_.time_of(path.pixel), surface);
    TextureLookup<float> lookup;
    surface.lookup = &lookup;
    const SurfaceInputs inputs = surface.inputs();
    arena_.clock.enter_part(Phase::textures);
    const float alpha = material.alpha_mode == AlphaMode::blend ? coverage(material, table_, inputs) : 1.0f;
    const Rgb arriving = arriving_weight(path, scene_.materials, hits.t[i]);
    Vec3f n = shading_normal(surface, material.normal_texture, material.normal_scale, table_);
    const bool enters = dot(n, ray.direction) < 0;
    if (!enters) n = -n;
    Shading s{ids, surface, material, ray.direction, -ray.direction, n, enters, arriving * alpha, path, cone, {}};
    arena_.clock.enter_part(Phase::shading);
    tell([&](TraceObserver& observer) { observer.hit({ids, hits.t[i], surface, n, enters, alpha, arriving}); });
    if (bounds_body(material)) {
      s.boundary =
          cross_boundary(path.media, surface.material, dot(surface.ng_world, ray.direction) < 0, scene_.materials);
      if (!s.boundary.seen) {
        tell([&](TraceObserver& observer) { observer.pass_unnoticed(); });
        return spawn_as(s, ray.direction, Bounce::straight,
                        {path.pixel, arriving, path.depth, path.kind, s.boundary.after, cone, path.roughness});
      }
    }
    if (alpha < 1) {
      // A texel that is not there at all costs no depth: foliage is made of many of them.
      const uint32_t depth = alpha > 0 ? path.depth + 1 : path.depth;
      spawn_as(s, ray.direction, Bounce::straight,
               {path.pixel, arriving * (1 - alpha), depth, kind_after(path.kind, Bounce::straight), path.media, cone,
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

 private:
  template <class Event>
  void tell(const Event& event) const {
    sink_.tell(event);
  }
  void add(const Path& path, LightTerm term, const Rgb& light) const { sink_.add(path.pixel, term, light); }

  /// Of what lies beyond the surface to what lies before it.
  static float relative_ior(const Shading& s) {
    return bounds_body(s.material) ? s.boundary.ior_after.g / s.boundary.ior_before.g : s.material.ior;
  }

  void shade_phong(const Shading& s, const PhongBsdf& bsdf) {
    add(s.path, LightTerm::ambient, s.weight * bsdf.ambient * ambient_light(scene_, s.n));
    const auto reflected = [&](const PhongBsdf& of, const Vec3f& to_light) {
      return reflected_light(of, s.n, to_light, s.b);
    };
    add_lights(s, bsdf, reflected);

    const bool body = bounds_body(s.material);
    const float eta = body ? s.boundary.ior_before.g / s.boundary.ior_after.g : s.enters ? 1 / bsdf.ior : bsdf.ior;
    Vec3f refracted;
    const bool transmits = max_component(bsdf.transmission) > 0;
    const bool passes = transmits && refract(s.d, s.n, eta, refracted);
    const float f = bsdf.fresnel ? fresnel_dielectric(smaller(1.0f, dot(s.n, s.b)), eta) : 0.0f;
    if (transmits) tell([&](TraceObserver& observer) { observer.part(phong_interface(s, bsdf, f, !passes)); });
    const PhongRays rays = ray_weights(bsdf, f, passes);
    spawn(s, reflect(s.d, s.n), s.weight * rays.mirrored, Bounce::mirror, s.path.media);
    if (passes)
      spawn(s, refracted, s.weight * rays.refracted, Bounce::refracted, body ? s.boundary.after : s.path.media, 0, eta);
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
    const Rgb ambient = albedo.diffuse * ambient_light(scene_, s.n) +
                        albedo.highlight * (1 - share) * blurred(scene_, mirrored, roughness);
    add(s.path, LightTerm::ambient, s.weight * ambient);
    add_lights(s, bsdf,
               [&](const MeasuredBsdf& of, const Vec3f& to_light) { return reflected_light(of, s.n, to_light, s.b); });
    spawn(s, above_surface(s.surface.ng_world, s.b, mirrored), s.weight * albedo.highlight * share, Bounce::mirror,
          s.path.media, roughness);
  }

  void shade_metallic_roughness(const Shading& s, const MetallicRoughnessBsdf& bsdf, const Rgb& emitted) {
    const LayerFrames frames = layer_frames(s, bsdf);
    const float share = mirror_share(bsdf.roughness), coat_share = mirror_share(bsdf.clearcoat_roughness);
    const float coat = coat_reflectance(bsdf, frames.coat_n, s.b);
    const float left = layers_transmittance(bsdf, frames, s.b);
    add(s.path, LightTerm::emission, emitted * (1 - coat));
    const DiffuseAlbedo diffuse = diffuse_albedo(bsdf, frames, s.b);
    Rgb ambient = diffuse.front * ambient_light(scene_, s.n);
    if (bsdf.diffuse_transmission > 0) ambient += diffuse.back * ambient_light(scene_, -s.n);
    // The part of the reflections that no mirror ray stands for.
    ambient += rough_reflection(s, bsdf) * (left * (1 - share));
    if (coat > 0)
      ambient += blurred(scene_, reflect(s.d, frames.coat_n), bsdf.clearcoat_roughness) * (coat * (1 - coat_share));
    add(s.path, LightTerm::ambient, s.weight * ambient * bsdf.occlusion);
    add_lights(s, bsdf, [&](const MetallicRoughnessBsdf& of, const Vec3f& to_light) {
      return reflected_light(of, frames, to_light, s.b);
    });

    const Transmission passing = transmission(s, bsdf);
    tell([&](TraceObserver& observer) {
      observer.part({s.boundary.ior_before, s.boundary.ior_after, passing.fresnel, true, !passing.passes});
    });
    const Rgb through = (Rgb(1.0f) - passing.fresnel) * bsdf.base_color;
    spawn(s, above_surface(s.surface.ng_world, s.b, reflect(s.d, frames.coat_n)), s.weight * (coat * coat_share),
          Bounce::mirror, s.path.media, bsdf.clearcoat_roughness);
    spawn(s, above_surface(s.surface.ng_world, s.b, reflect(s.d, s.n)), s.weight * passing.fresnel * (left * share),
          Bounce::mirror, s.path.media, bsdf.roughness);
    spawn_transmitted(s, through * (left * bsdf.transmission * (1 - bsdf.metallic)), passing, bsdf.roughness);
  }

  /// What a rough surface reflects of the environment; without one, of the ambient light, and then metals only: they
  /// have no diffuse light to be seen by.
  [[nodiscard]] Rgb rough_reflection(const Shading& s, const MetallicRoughnessBsdf& bsdf) const {
    if (!scene_.environment) return bsdf.base_color * bsdf.metallic * scene_.ambient;
    return specular_albedo(bsdf, std::max(0.0f, dot(s.n, s.b))) * blurred(scene_, reflect(s.d, s.n), bsdf.roughness);
  }

  [[nodiscard]] LayerFrames layer_frames(const Shading& s, const MetallicRoughnessBsdf& bsdf) const {
    LayerFrames frames{ShadingFrame{{}, {}, s.n}, s.n};
    if (bsdf.clearcoat > 0) {
      const Clearcoat& coat = s.material.clearcoat;
      const Vec3f n = shading_normal(s.surface, coat.normal_texture, coat.normal_scale, table_);
      frames.coat_n = dot(n, s.b) < 0 ? -n : n;
    }
    if (bsdf.anisotropy > 0 && has_tangent(s.surface)) {
      const float angle = anisotropy_angle(s.material, table_, s.surface.inputs());
      const Vec3f along = world_from_tangent(s.surface, Vec3f{std::cos(angle), std::sin(angle), 0});
      frames.base.t = normalize(along - s.n * dot(s.n, along));
      frames.base.b = cross(s.n, frames.base.t);
    } else if (bsdf.anisotropy > 0) {
      frames.base = frame_about(s.n);
    }
    return frames;
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
        spawn(s, passing.direction, s.weight * share, Bounce::refracted, passing.media, roughness, passing.eta);
      return;
    }
    // A ray for each of red, green and blue; the colours of a ray that was split before go on alone.
    const auto spawn_color = [&](float eta, const Rgb& color) {
      Vec3f refracted;
      if (refract(s.d, s.n, eta, refracted))
        spawn(s, refracted, s.weight * share * color, Bounce::refracted, passing.media, roughness, eta);
    };
    spawn_color(before.r / after.r, {1, 0, 0});
    spawn_color(before.g / after.g, {0, 1, 0});
    spawn_color(before.b / after.b, {0, 0, 1});
  }

  /// `eta`: the index before the surface to that beyond it, of a ray that is refracted.
  void spawn(const Shading& s, const Vec3f& direction, const Rgb& weight, Bounce bounce, const Media& media,
             float roughness = 0, float eta = 1) {
    if (!(max_component(weight) > 0)) return;
    const Cone cone = cone_of(s.path, s.ids, s.surface, s.cone, s.d, s.n, normalize(direction), eta);
    spawn_as(s, direction, bounce, next_path(s.path, weight, bounce, media, cone, roughness));
  }

  /// Cones serve textures alone, so that a scene without any does not pay for the curvature.
  [[nodiscard]] Cone cone_of(const Path& path, const HitIds& ids, const SurfacePoint& surface, const Cone& cone,
                             const Vec3f& d, const Vec3f& n, const Vec3f& direction, float eta) const {
    if (scene_.images.empty()) return cone;
    const float outward = mean_curvature(scene_, ids, surface, cone.width, arena_.time_of(path.pixel));
    const float curvature = dot(surface.ns_world, d) < 0 ? outward : -outward;
    return {cone.width, deflected_spread(cone.width, cone.spread, d, n, direction, eta, curvature)};
  }

  /// One deeper than `path`, from a surface of that roughness.
  static Path next_path(const Path& path, const Rgb& weight, Bounce bounce, const Media& media, const Cone& cone,
                        float roughness) {
    return {path.pixel,
            weight,
            path.depth + 1,
            kind_after(path.kind, bounce),
            media,
            cone,
            blurred_by(path.roughness, roughness)};
  }

  [[nodiscard]] SpawnOutcome outcome_of(const Path& path) const {
    const float largest = max_component(path.weight);
    if (int(path.depth) > options_.max_depth) return SpawnOutcome::depth_limit;
    return largest >= options_.min_weight && largest > 0 ? SpawnOutcome::traced : SpawnOutcome::weight_limit;
  }

  void spawn_as(const Shading& s, const Vec3f& direction, Bounce bounce, const Path& path) {
    const SpawnOutcome outcome = outcome_of(path);
    const auto ray = [&] { return Rayf{spawn_origin(s.surface, direction), normalize(direction)}; };
    if (outcome == SpawnOutcome::traced) arena_.spawned[bounce].push(ray(), path);
    tell([&](TraceObserver& observer) { observer.spawn(ray(), path, bounce, outcome); });
  }

  /// Queues one shadow ray for each light whose reflected light is not 0; `reflected(bsdf, to_light)` says how much.
  template <class Bsdf, class Reflected>
  void add_lights(const Shading& s, const Bsdf& bsdf, const Reflected& reflected) {
    for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
      const Light& light = scene_.lights[i];
      if (light.track.empty())
        add_light(s, i, light, bsdf, reflected);
      else
        add_light(s, i, at_time(light.track, arena_.time_of(s.path.pixel)), bsdf, reflected);
    }
  }

  /// `light`: that of the index, as it is at the ray's time.
  template <class Bsdf, class Reflected>
  void add_light(const Shading& s, uint32_t index, const Light& light, const Bsdf& bsdf, const Reflected& reflected) {
    const ArrivingLight<float> arriving = light_at<float>(light, s.surface.p_world);
    if (!(max_component(arriving.radiance) > 0)) return;
    const Vec3f& to_light = arriving.to_light;
    const Rgb light_to_eye = s.weight * arriving.radiance * reflected(bsdf, to_light);
    if (!(max_component(light_to_eye) > 0)) return;
    Rayf ray{spawn_origin(s.surface, to_light), to_light};
    if (light.kind != Light::Kind::directional) {
      // From the shifted origin to the light itself, in units of the segment.
      ray.direction = Vec3f(light.p_world - Vec3d(ray.origin)), ray.t_max = 1;
    }
    tell([&](TraceObserver& observer) {
      const Rgb all = reflected(bsdf, to_light), specular = reflected(without_diffuse(bsdf), to_light);
      observer.ask({index, ray, arriving.distance, arriving.radiance, s.weight, all - specular, specular});
    });
    push_shadow(index, ray, s.path.pixel, light_to_eye);
  }

  /// `light`: what the pixel gets of it where nothing is in the way.
  void push_shadow(uint32_t of_light, const Rayf& ray, uint32_t pixel, const Rgb& light) {
    ShadowWave& wave = arena_.shadow_by_light[of_light];
    wave.rays.push(ray);
    wave.pixel.push(pixel), wave.red.push(light.r), wave.green.push(light.g), wave.blue.push(light.b);
    if constexpr (observed) wave.number.push(uint32_t(arena_.shadows_waiting));
    ++arena_.shadows_waiting;
  }

  const Scene& scene_;
  const RenderOptions& options_;
  WaveArena& arena_;
  PixelSink<observed> sink_;
  TextureTable table_;
};

}  // namespace

template <bool observed>
void shade_hit(const Scene& scene, const RenderOptions& options, const PixelSink<observed>& sink, size_t i) {
  HitShader<observed>(scene, options, sink).shade(i);
}
template void shade_hit(const Scene&, const RenderOptions&, const PixelSink<false>&, size_t);
template void shade_hit(const Scene&, const RenderOptions&, const PixelSink<true>&, size_t);

}  // namespace alhazen
