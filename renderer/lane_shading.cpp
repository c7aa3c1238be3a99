#include "renderer/lane_shading.h"

#include <numbers>
#include <optional>

#include "materials/phong.h"
#include "renderer/camera_ray.h"
#include "renderer/light.h"
#include "renderer/shading_terms.h"

namespace alhazen {
namespace {

using F = ShadingLanes;
using Mask = MaskOf<F>;
using Color = BasicRgb<F>;

struct Hit {
  std::optional<LaneTriangles> triangles;
  BasicSurfacePoint<F> surface;
  Vec3<F> d, b, n;  // ray direction, back along it, shading normal turned towards b
  Mask enters;
  Color weight;
  F eta;  // the index before the surface to that beyond it

  /// Not an aggregate: of one, GCC 12 clears all the memory first.
  Hit(const Scene& scene, const ShadingGroup& group, const LaneWork& work)
      : surface(surface_points(scene, work.hits, group.attributes, group.has_textures, triangles)),
        d(work.hits.direction.load()),
        b(-d),
        weight(work.weight.load()) {
    surface.footprint = footprint(work.cone_width.load(), surface.ng_world, d);
  }
};

const Color kBlack(F(0));

void set_ray(const Hit& hit, const Vec3<F>& direction, const Color& weight, const Mask& wanted, LaneRays& rays) {
  const Mask lanes = wanted && max_component(weight) > F(0);
  rays.lanes = lane_bits(lanes);
  if (rays.lanes == 0) return;
  rays.weight.store(weight);
  rays.origin.store(spawn_origin(hit.surface, direction)), rays.direction.store(normalize(direction));
}

template <class Reflected>
void set_shadow_ray(const Hit& hit, const Light& light, const Reflected& reflected, LaneRays& rays) {
  const ArrivingLight<F> arriving = light_at<F>(light, hit.surface.p_world);
  const Mask arrives = max_component(arriving.radiance) > F(0);
  rays.lanes = 0;
  if (!any_of(arrives)) return;
  const Color to_eye = hit.weight * arriving.radiance * reflected(arriving.to_light);
  const Mask lanes = arrives && max_component(to_eye) > F(0);
  rays.lanes = lane_bits(lanes);
  if (rays.lanes == 0) return;
  rays.weight.store(to_eye);
  const Vec3<F> origin = spawn_origin(hit.surface, arriving.to_light);
  rays.origin.store(origin);
  if (light.kind == Light::Kind::directional) {
    rays.direction.store(arriving.to_light), rays.t_max.store(arriving.distance);
  } else {
    using D = DoubleOf<F>;
    const Vec3<D> p(D(light.p_world.x), D(light.p_world.y), D(light.p_world.z));
    rays.direction.store(convert<F>(p - convert<D>(origin))), rays.t_max.store(F(1));
  }
}

template <class Reflected>
void set_shadow_rays(const Scene& scene, const Hit& hit, const Reflected& reflected, LaneLight& out) {
  out.shadow.resize(scene.lights.size());
  for (size_t k = 0; k < scene.lights.size(); ++k) set_shadow_ray(hit, scene.lights[k], reflected, out.shadow[k]);
}

void shade_phong(const Scene& scene, const BasicPhongBsdf<F>& bsdf, Hit& hit, LaneLight& out) {
  out.ambient.store(hit.weight * bsdf.ambient * ambient_light(scene, hit.n));
  set_shadow_rays(
      scene, hit, [&](const Vec3<F>& to_light) { return reflected_light(bsdf, hit.n, to_light, hit.b); }, out);
  out.roughness.store(F(0));
  const bool transmits = max_component(bsdf.transmission) > 0;
  if (!transmits && !(max_component(bsdf.reflection) > 0)) return;
  const F eta = select(hit.enters, F(1 / bsdf.ior), F(bsdf.ior));
  hit.eta = eta;
  Vec3<F> refracted;
  const Mask passes = transmits ? refract(hit.d, hit.n, eta, refracted) : Mask(false);
  const F f = bsdf.fresnel ? fresnel_dielectric(smaller(F(1), dot(hit.n, hit.b)), eta) : F(0);
  const BasicPhongRays<F> rays = ray_weights(bsdf, f, passes);
  set_ray(hit, reflect(hit.d, hit.n), hit.weight * rays.mirrored, Mask(true), out.mirror);
  if (any_of(passes)) set_ray(hit, refracted, hit.weight * rays.refracted, passes, out.refracted);
}

/// BSDF x cosine for one light.
Color reflected_light(const BaseLayer<F>& base, const Hit& hit, const Vec3<F>& s) {
  const F ns = dot(hit.n, s);
  const Mask faces = ns > F(0);
  if (!any_of(faces)) return kBlack;
  const Vec3<F> h = unit_vector(s + hit.b);
  const F bh = dot(hit.b, h), nb = larger(F(0), dot(hit.n, hit.b));
  const F alpha = larger(F(1e-3f), F(base.roughness * base.roughness));
  const F lobe = isotropic_ggx(alpha, ns, nb, hit.n, h);
  const F specular = select(Mask(faces && dot(hit.n, h) > F(0)), lobe, F(0));
  const Color diffuse = base.base_color * F(std::numbers::inv_pi_v<float>);
  return select(faces, base_light(base, base_fresnel(base, bh), diffuse, specular, ns), kBlack);
}

void shade_metallic_roughness(const Scene& scene, const BaseLayer<F>& base, const Hit& hit, LaneLight& out) {
  const F share = mirror_share(base.roughness), nb = larger(F(0), dot(hit.n, hit.b));
  const Vec3<F> mirrored = reflect(hit.d, hit.n);
  Color ambient = base.base_color * (F(1) - base.metallic) * ambient_light(scene, hit.n);
  Color rough;
  if (scene.environment) {
    const BasicSplitSum<F> split = ggx_albedo<F>(base.roughness, nb);
    const Color dielectric = base.dielectric_f0 * split.scale + Color(base.dielectric_f90 * split.bias);
    const Color metal = base.base_color * split.scale + Color(split.bias);
    rough = lerp(dielectric, metal, base.metallic) * blurred(scene, mirrored, base.roughness);
  } else {
    rough = base.base_color * base.metallic * Color(scene.ambient);
  }
  ambient += rough * (F(1) - share);
  out.ambient.store(hit.weight * ambient * base.occlusion);
  set_shadow_rays(
      scene, hit, [&](const Vec3<F>& to_light) { return reflected_light(base, hit, to_light); }, out);

  out.roughness.store(base.roughness);
  if (!any_of(share > F(0))) return;
  const BaseFresnel<F> fresnel = base_fresnel(base, nb);
  const Color reflectance = lerp(fresnel.dielectric, fresnel.metal, base.metallic);
  set_ray(hit, above_surface(hit.surface.ng_world, hit.b, mirrored), hit.weight * reflectance * share, Mask(true),
          out.mirror);
}

/// What the surface does not cover goes on; what it covers is left to be shaded.
void let_through(const Material& material, const TextureTable& table, const BasicSurfaceInputs<F>& inputs,
                 const LaneWork& work, Hit& hit, LaneLight& out) {
  const F alpha = coverage(material, table, inputs);
  out.alpha.store(alpha);
  set_ray(hit, hit.d, hit.weight * (F(1) - alpha), alpha < F(1), out.straight);
  out.straight.cone_spread = work.cone_spread;
  hit.weight = select(alpha > F(0), hit.weight * alpha, kBlack);
}

/// Cones serve textures alone, so that a scene without any does not pay for the curvature.
void set_cones(const Scene& scene, const ShadingGroup& group, const LaneWork& work, const Hit& hit, LaneLight& out) {
  const F width = work.cone_width.load(), spread = work.cone_spread.load();
  out.mirror.cone_spread = out.refracted.cone_spread = work.cone_spread;
  if (scene.images.empty()) return;
  const F outward = mean_curvature(scene, work.hits, group.attributes, hit.surface, hit.triangles, width);
  const F curvature = select(dot(hit.surface.ns_world, hit.d) < F(0), outward, -outward);
  const auto set = [&](LaneRays& rays, const F& eta) {
    if (rays.lanes == 0) return;
    rays.cone_spread.store(deflected_spread(width, spread, hit.d, hit.n, rays.direction.load(), eta, curvature));
  };
  set(out.mirror, F(1)), set(out.refracted, hit.eta);
}

}  // namespace

void shade_lanes(const Scene& scene, const ShadingGroup& group, const LaneWork& work, PhaseClock& clock,
                 LaneLight& out) {
  const Material& material = scene.materials[group.material];
  const TextureTable table = texture_table(scene);
  clock.enter_part(Phase::surface_points);
  Hit hit(scene, group, work);
  for (LaneRays* rays : {&out.straight, &out.mirror, &out.refracted}) rays->lanes = 0;
  for (LaneRays& rays : out.shadow) rays.lanes = 0;
  TextureLookup<F> lookup;
  hit.surface.lookup = &lookup;
  clock.enter_part(group.has_textures ? Phase::textures : Phase::shading);
  const BasicSurfaceInputs<F> inputs = hit.surface.inputs();
  if (group.has_textures)
    prefetch(table, texture_uses(material), material.model == ShadingModel::phong ? point_inputs(inputs) : inputs);
  if (material.alpha_mode == AlphaMode::blend) let_through(material, table, inputs, work, hit, out);
  hit.n = shading_normal(hit.surface, material.normal_texture, material.normal_scale, table);
  hit.enters = dot(hit.n, hit.d) < F(0);
  hit.n = select(hit.enters, hit.n, -hit.n);
  const bool unlit = material.model == ShadingModel::unlit;
  out.emits = unlit || max_component(material.emissive) > 0, out.reflects = !unlit;
  if (out.emits) out.emission.store(hit.weight * emission(material, table, inputs));
  if (material.model == ShadingModel::phong) {
    const auto bsdf = phong_bsdf(material, table, inputs);
    clock.enter_part(Phase::shading);
    shade_phong(scene, bsdf, hit, out);
  } else if (out.reflects) {
    const BaseLayer<F> base = base_layer(material, table, inputs, material.ior);
    clock.enter_part(Phase::shading);
    shade_metallic_roughness(scene, base, hit, out);
  } else {
    clock.enter_part(Phase::shading);
  }
  if ((out.mirror.lanes | out.refracted.lanes) != 0) set_cones(scene, group, work, hit, out);
}

}  // namespace alhazen
