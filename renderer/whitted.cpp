#include "renderer/whitted.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "core/lane_memory.h"
#include "materials/fresnel.h"
#include "materials/metallic_roughness.h"
#include "materials/phong.h"
#include "renderer/lane_shading.h"
#include "renderer/light.h"
#include "renderer/moving.h"
#include "renderer/shading_terms.h"
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

bool is_view(RayKind kind) { return kind == RayKind::camera || kind == RayKind::straight; }

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
  Whitted(const Scene& scene, const AcceleratedScene& accelerated, const ShadingGroups& groups,
          const RenderOptions& options, WaveArena& arena, Rgb* radiance, float* background)
      : scene_(scene),
        accelerated_(accelerated),
        groups_(groups),
        options_(options),
        arena_(arena),
        radiance_(radiance),
        background_(background),
        table_(texture_table(scene)) {
    arena_.shadow_by_light.resize(scene.lights.size());
  }

  void run() {
    bool first = true;
    while (arena_.pending.size() > 0) {
      take_wave();
      count_rays(first);
      set_times(arena_.current.rays, [&](size_t i) { return arena_.current.paths.pixel[i]; });
      log(first ? WaveKind::camera : WaveKind::bounced, arena_.current.rays);
      coherence_ = first ? Coherence::coherent : Coherence::incoherent;
      arena_.clock.enter(Phase::traversal);
      accelerated_.intersect(arena_.current.rays, coherence_, arena_.hits);
      arena_.clock.enter(Phase::shading);
      shade_wave();
      trace_shadows();
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

  void count_rays(bool of_camera) {
    const size_t n = arena_.current.size();
    if (of_camera) {
      arena_.rays_by_kind[size_t(RayKind::camera)] += n;
      return;
    }
    for (size_t i = 0; i < n; ++i) ++arena_.rays_by_kind[size_t(arena_.current.paths.kind[i])];
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
    to.append(from, first);
    from.resize(first);
  }

  /// Group by group, so that those on one material can go side by side. An observer gets to see them one by one, in the
  /// same order.
  void shade_wave() {
    sort_by_group();
    const bool lanes = !observed && arena_.time_of_pixel.size() == 0;
    uint32_t* const rays = arena_.sorted.data();
    size_t first = 0;
    for (size_t group = 0; group < groups_.size(); ++group) {
      const size_t end = arena_.group_ends[group];
      for (; first < end; first += std::min(kLanes, end - first)) {
        const std::span<const uint32_t> block(rays + first, std::min(kLanes, end - first));
        if (lanes && groups_[group].in_lanes)
          shade_in_lanes(groups_[group], block);
        else
          shade_one_by_one(block);
        if (shadows_ >= kShadowLimit) trace_shadows();
      }
    }
    shade_misses({rays + first, arena_.current.size() - first});
  }

  void shade_one_by_one(std::span<const uint32_t> hits) {
    for (const uint32_t i : hits) {
      tell([&](TraceObserver& observer) { observer.look_at(i); });
      shade(i);
    }
  }

  /// Counts, then places: `sorted` holds the wave's numbers group after group, each in the wave's order, and what
  /// misses after the last group.
  void sort_by_group() {
    const HitWave& hits = arena_.hits;
    const size_t n = arena_.current.size(), misses = groups_.size();
    Lanes<uint32_t>&ends = arena_.group_ends, &group_of = arena_.group_of_hit;
    ends.resize(misses + 1), group_of.resize(n), arena_.sorted.resize(n);
    std::fill_n(ends.data(), ends.size(), 0);
    for (size_t i = 0; i < n; ++i)
      group_of[i] =
          hits.object[i] == kNone ? uint32_t(misses) : groups_.of(scene_.geometry, hits.object[i], hits.part[i]);
    // Neighbours are mostly of one group, whose number is kept at hand.
    const auto for_each_place = [&](const auto& visit) {
      size_t group = misses;
      uint32_t end = ends[group];
      for (size_t i = 0; i < n; ++i) {
        if (group_of[i] != group) ends[group] = end, group = group_of[i], end = ends[group];
        visit(i, end++);
      }
      ends[group] = end;
    };
    for_each_place([](size_t, uint32_t) {});
    uint32_t sum = 0;
    for (size_t group = 0; group <= misses; ++group) sum += std::exchange(ends[group], sum);
    for_each_place([&](size_t i, uint32_t place) { arena_.sorted[place] = uint32_t(i); });
  }

  static constexpr size_t kLanes = kWidthOf<ShadingLanes>;

  /// First those that see the background; the others' numbers move to the front of `rays`.
  void shade_misses(std::span<uint32_t> rays) {
    size_t others = 0;
    for (const uint32_t i : rays) {
      const RayKind kind = arena_.current.paths.kind[i];
      const bool uncovers = options_.transparent && is_view(kind);
      if (!uncovers && !sees_background(kind)) {
        rays[others++] = i;
        continue;
      }
      const Path path = arena_.current.paths[i];
      tell([&](TraceObserver& observer) { observer.look_at(i); });
      if (!uncovers) {
        add(path, LightTerm::background, path.weight * scene_.background);
        continue;
      }
      background_[path.pixel] += path.weight.r;  // a product of (1 - alpha): grey
      tell([&](TraceObserver& observer) { observer.uncover(path.weight.r); });
    }
    constexpr size_t kTogether = observed ? 1 : kLanes;
    for (size_t first = 0; first < others; first += kTogether)
      add_environment(rays.subspan(first, std::min(kTogether, others - first)));
  }

  void add_environment(std::span<const uint32_t> rays) {
    if constexpr (observed) {
      const Path path = arena_.current.paths[rays[0]];
      tell([&](TraceObserver& observer) { observer.look_at(rays[0]); });
      const Vec3f direction = arena_.current.rays.direction.get(rays[0]);
      return add(path, LightTerm::environment,
                 path.weight * environment_radiance(*scene_.environment, direction, path.roughness));
    }
    const PathRows& paths = arena_.current.paths;
    const RayWave& wave = arena_.current.rays;
    LaneArray<IntOf<ShadingLanes>> numbers;
    for (size_t k = 0; k < kLanes; ++k) numbers[k] = int32_t(rays[k < rays.size() ? k : 0]);
    const LanePicker<ShadingLanes> picker(numbers.load(), rays.front(), rays.back());
    const auto load = [&](const Lanes<float>& row) { return picker.pick<ShadingLanes>(row); };
    const Vec3<ShadingLanes> direction{load(wave.direction.x), load(wave.direction.y), load(wave.direction.z)};
    const BasicRgb<ShadingLanes> weight{load(paths.red), load(paths.green), load(paths.blue)};
    RgbArray<ShadingLanes> light;
    light.store(weight * environment_radiance(*scene_.environment, direction, load(paths.roughness)));
    for (size_t k = 0; k < rays.size(); ++k) radiance_[paths.pixel[rays[k]]] += light.get(k);
  }

  void shade_in_lanes(const ShadingGroup& group, std::span<const uint32_t> hits) {
    load_lanes(hits);
    LaneLight& light = arena_.lane_light;
    shade_lanes(scene_, group, arena_.lane_work, arena_.clock, light);
    const auto& pixel = arena_.lane_work.pixel;
    if (light.emits)
      for (size_t k = 0; k < hits.size(); ++k) radiance_[pixel[k]] += light.emission.get(k);
    for (size_t k = 0; k < hits.size(); ++k) radiance_[pixel[k]] += light.ambient.get(k);
    const uint32_t present = (1u << hits.size()) - 1;
    for (size_t k = 0; k < light.shadow.size(); ++k) push_shadows(k, light.shadow[k], light.shadow[k].lanes & present);
    push_spawned(hits, present);
  }

  /// Lanes beyond the last hit are as the first.
  void load_lanes(std::span<const uint32_t> hits) {
    LaneWork& work = arena_.lane_work;
    const RayWave& rays = arena_.current.rays;
    const PathRows& paths = arena_.current.paths;
    const HitWave& found = arena_.hits;
    LaneArray<IntOf<ShadingLanes>> numbers;
    for (size_t k = 0; k < kLanes; ++k) {
      const uint32_t i = hits[k < hits.size() ? k : 0];
      numbers[k] = int32_t(i);
      work.hits.ids[k] = {found.object[i], found.part[i], found.primitive[i]};
    }
    const LanePicker<ShadingLanes> picker(numbers.load(), hits.front(), hits.back());
    const auto load = [&](const Lanes<float>& row) { return picker.pick<ShadingLanes>(row); };
    const auto load_number = [&](const Lanes<uint32_t>& row) { return picker.pick<UintOf<ShadingLanes>>(row); };
    const ShadingLanes t = load(found.t);
    work.hits.origin.store({load(rays.origin.x), load(rays.origin.y), load(rays.origin.z)});
    work.hits.direction.store({load(rays.direction.x), load(rays.direction.y), load(rays.direction.z)});
    work.hits.t.store(t), work.hits.u.store(load(found.u)), work.hits.v.store(load(found.v));
    work.weight.store({load(paths.red), load(paths.green), load(paths.blue)});
    for (size_t k = 0; k < kLanes && paths.media.size() > 0; ++k)
      work.weight.set(k, arriving_weight(paths[size_t(numbers[k])], found.t[size_t(numbers[k])]));
    const BasicCone<ShadingLanes> cone = BasicCone<ShadingLanes>{load(paths.cone_width), load(paths.cone_spread)}.at(t);
    work.cone_width.store(cone.width), work.cone_spread.store(cone.spread);
    work.roughness.store(load(paths.roughness));
    work.pixel.store(load_number(paths.pixel)), work.depth.store(load_number(paths.depth));
  }

  void push_shadows(size_t of_light, const LaneRays& rays, uint32_t lanes) {
    if (lanes == 0) return;
    ShadowWave& wave = arena_.shadow_by_light[of_light];
    const auto append = [&](Lanes<float>& row, const LaneArray<ShadingLanes>& values) {
      append_lanes(row, lanes, values.values);
    };
    append(wave.rays.origin.x, rays.origin.x), append(wave.rays.origin.y, rays.origin.y);
    append(wave.rays.origin.z, rays.origin.z), append(wave.rays.direction.x, rays.direction.x);
    append(wave.rays.direction.y, rays.direction.y), append(wave.rays.direction.z, rays.direction.z);
    append(wave.rays.t_min, LaneArray<ShadingLanes>{}), append(wave.rays.t_max, rays.t_max);
    append(wave.red, rays.weight.r), append(wave.green, rays.weight.g), append(wave.blue, rays.weight.b);
    append_lanes(wave.pixel, lanes, arena_.lane_work.pixel.values);
    shadows_ += size_t(std::popcount(lanes));
  }

  /// Of the rays of a block that go on, those whose bit is set.
  [[nodiscard]] uint32_t traced_lanes(const LaneRays& rays, uint32_t lanes) const {
    if (lanes == 0) return 0;
    const ShadingLanes largest = max_component(rays.weight.load());
    const auto matters = largest >= ShadingLanes(options_.min_weight) && largest > ShadingLanes(0);
    const auto shallow =
        convert_mask<ShadingLanes>(arena_.lane_work.depth.load() < UintOf<ShadingLanes>(uint32_t(options_.max_depth)));
    return lane_bits(matters && shallow) & lanes;
  }

  /// What the hits of a block spawned, ray by ray in the order in which they would be spawned one by one.
  void push_spawned(std::span<const uint32_t> hits, uint32_t present) {
    const LaneRays &mirror = arena_.lane_light.mirror, &refracted = arena_.lane_light.refracted;
    const uint32_t mirrored = traced_lanes(mirror, mirror.lanes & present),
                   passing = traced_lanes(refracted, refracted.lanes & present);
    if ((mirrored | passing) == 0) return;
    const LaneWork& work = arena_.lane_work;
    PathWave& to = arena_.pending;
    const auto append = [&](auto& row, const auto& of_mirror, const auto& of_refracted) {
      append_pairs(row, mirrored, of_mirror.values, passing, of_refracted.values);
    };
    const auto append_both = [&](auto& row, const auto& of_both) { append(row, of_both, of_both); };
    const auto all = [](auto value) {
      struct {
        std::array<decltype(value), kLanes> values;
      } same;
      same.values.fill(value);
      return same;
    };
    const PathRows& from = arena_.current.paths;
    size_t next = to.size();
    for (uint32_t lanes = from.media.size() > 0 ? mirrored | passing : 0; lanes; lanes &= lanes - 1) {
      const auto k = size_t(std::countr_zero(lanes));
      const Media media = from.media_of(hits[k]);
      if (mirrored >> k & 1) to.paths.set_media(next++, media);
      if (passing >> k & 1) to.paths.set_media(next++, media);
    }
    append(to.rays.origin.x, mirror.origin.x, refracted.origin.x);
    append(to.rays.origin.y, mirror.origin.y, refracted.origin.y);
    append(to.rays.origin.z, mirror.origin.z, refracted.origin.z);
    append(to.rays.direction.x, mirror.direction.x, refracted.direction.x);
    append(to.rays.direction.y, mirror.direction.y, refracted.direction.y);
    append(to.rays.direction.z, mirror.direction.z, refracted.direction.z);
    append_both(to.rays.t_min, all(Rayf{}.t_min)), append_both(to.rays.t_max, all(Rayf{}.t_max));
    append(to.paths.red, mirror.weight.r, refracted.weight.r);
    append(to.paths.green, mirror.weight.g, refracted.weight.g);
    append(to.paths.blue, mirror.weight.b, refracted.weight.b);
    append(to.paths.kind, all(RayKind::mirror), all(RayKind::refracted));
    append(to.paths.cone_spread, mirror.cone_spread, refracted.cone_spread);
    append_both(to.paths.cone_width, work.cone_width);
    append_both(to.paths.pixel, work.pixel);
    LaneArray<UintOf<ShadingLanes>> depth;
    depth.store(work.depth.load() + 1);
    append_both(to.paths.depth, depth);
    LaneArray<ShadingLanes> roughness;
    roughness.store(blurred_by(work.roughness.load(), arena_.lane_light.roughness.load()));
    append_both(to.paths.roughness, roughness);
  }

  /// What is left of a ray's weight after a distance.
  [[nodiscard]] Rgb arriving_weight(const Path& path, float t) const {
    return path.media.count > 0 ? path.weight * transmittance(path.media, scene_.materials, t) : path.weight;
  }

  void shade(size_t i) {
    const Path path = arena_.current.paths[i];
    const HitWave& hits = arena_.hits;
    const Rayf ray = arena_.current.rays.get(i);
    const HitIds ids{hits.object[i], hits.part[i], hits.primitive[i]};
    arena_.clock.enter_part(Phase::surface_points);
    SurfacePoint surface = surface_point(scene_, ray, ids, hits.t[i], hits.u[i], hits.v[i], time_of(path.pixel));
    const Cone cone = path.cone.at(hits.t[i]);
    surface.footprint = footprint(cone.width, surface.ng_world, ray.direction);
    const Material& material = scene_.materials[surface.material];
    if (!scene_.images.empty() && material.model != ShadingModel::phong)  // which knows no mipmaps
      measure_shape_uvs(scene_, ids, surface.footprint, time_of(path.pixel), surface);
    TextureLookup<float> lookup;
    surface.lookup = &lookup;
    const SurfaceInputs inputs = surface.inputs();
    arena_.clock.enter_part(Phase::textures);
    const float alpha = material.alpha_mode == AlphaMode::blend ? coverage(material, table_, inputs) : 1.0f;
    const Rgb arriving = arriving_weight(path, hits.t[i]);
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
        return spawn_as(s, ray.direction,
                        {path.pixel, arriving, path.depth, path.kind, s.boundary.after, cone, path.roughness});
      }
    }
    if (alpha < 1) {
      // A texel that is not there at all costs no depth: foliage is made of many of them.
      const uint32_t depth = alpha > 0 ? path.depth + 1 : path.depth;
      spawn_as(s, ray.direction,
               {path.pixel, arriving * (1 - alpha), depth, is_view(path.kind) ? RayKind::straight : path.kind,
                path.media, cone, path.roughness});
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

  /// Of a ray that leaves the scene; else it sees the environment.
  [[nodiscard]] bool sees_background(RayKind kind) const {
    if (!scene_.environment) return true;
    return scene_.environment->seen ? is_view(kind) && scene_.has_background : kind != RayKind::mirror;
  }

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
    const Rgb ambient = albedo.diffuse * ambient_light(scene_, s.n) +
                        albedo.highlight * (1 - share) * blurred(scene_, mirrored, roughness);
    add(s.path, LightTerm::ambient, s.weight * ambient);
    add_lights(s, bsdf,
               [&](const MeasuredBsdf& of, const Vec3f& to_light) { return reflected_light(of, s.n, to_light, s.b); });
    spawn(s, above_surface(s.surface.ng_world, s.b, mirrored), s.weight * albedo.highlight * share, RayKind::mirror,
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
          RayKind::mirror, s.path.media, bsdf.clearcoat_roughness);
    spawn(s, above_surface(s.surface.ng_world, s.b, reflect(s.d, s.n)), s.weight * passing.fresnel * (left * share),
          RayKind::mirror, s.path.media, bsdf.roughness);
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
    const Cone cone = cone_of(s.path, s.ids, s.surface, s.cone, s.d, s.n, normalize(direction), eta);
    spawn_as(s, direction, next_path(s.path, weight, kind, media, cone, roughness));
  }

  /// Cones serve textures alone, so that a scene without any does not pay for the curvature.
  [[nodiscard]] Cone cone_of(const Path& path, const HitIds& ids, const SurfacePoint& surface, const Cone& cone,
                             const Vec3f& d, const Vec3f& n, const Vec3f& direction, float eta) const {
    if (scene_.images.empty()) return cone;
    const float outward = mean_curvature(scene_, ids, surface, cone.width, time_of(path.pixel));
    const float curvature = dot(surface.ns_world, d) < 0 ? outward : -outward;
    return {cone.width, deflected_spread(cone.width, cone.spread, d, n, direction, eta, curvature)};
  }

  /// One deeper than `path`, from a surface of that roughness.
  static Path next_path(const Path& path, const Rgb& weight, RayKind kind, const Media& media, const Cone& cone,
                        float roughness) {
    return {path.pixel, weight, path.depth + 1, kind, media, cone, blurred_by(path.roughness, roughness)};
  }

  /// The roughness of two surfaces one after the other.
  template <class F>
  static F blurred_by(const F& before, const F& then) {
    return smaller(F(square_root(F(before * before + then * then))), F(1));
  }

  [[nodiscard]] SpawnOutcome outcome_of(const Path& path) const {
    const float largest = max_component(path.weight);
    if (int(path.depth) > options_.max_depth) return SpawnOutcome::depth_limit;
    return largest >= options_.min_weight && largest > 0 ? SpawnOutcome::traced : SpawnOutcome::weight_limit;
  }

  void spawn_as(const Shading& s, const Vec3f& direction, const Path& path) {
    const SpawnOutcome outcome = outcome_of(path);
    if (outcome == SpawnOutcome::traced)
      arena_.pending.push({spawn_origin(s.surface, direction), normalize(direction)}, path);
    tell_spawn(s, direction, path, outcome);
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
    if constexpr (observed) wave.number.push(uint32_t(shadows_));
    ++shadows_;
  }

  /// Light by light, so that neighbours run side by side.
  void trace_shadows() {
    if (shadows_ == 0) return;
    ShadowWave& all = gather_shadows();
    arena_.shadow_rays += std::exchange(shadows_, 0);
    set_times(all.rays, [&](size_t i) { return all.pixel[i]; });
    log(coherence_ == Coherence::coherent ? WaveKind::camera_shadow : WaveKind::bounced_shadow, all.rays);
    arena_.clock.enter(Phase::traversal);
    accelerated_.transmittance(all.rays, coherence_, arena_.visible);
    arena_.clock.enter(Phase::shading);
    for (size_t i = 0; i < all.size(); ++i) {
      const Rgb light = Rgb{all.red[i], all.green[i], all.blue[i]} * arena_.visible[i];
      radiance_[all.pixel[i]] += light;
      tell([&](TraceObserver& observer) { observer.answer(all.number[i], arena_.visible[i], light); });
    }
    tell([&](TraceObserver& observer) { observer.answered(); });
    all.clear();
  }

  ShadowWave& gather_shadows() {
    if (arena_.shadow_by_light.size() == 1) return arena_.shadow_by_light[0];
    for (ShadowWave& wave : arena_.shadow_by_light) arena_.shadow.append(wave), wave.clear();
    return arena_.shadow;
  }

  const Scene& scene_;
  const AcceleratedScene& accelerated_;
  const ShadingGroups& groups_;
  const RenderOptions& options_;
  WaveArena& arena_;
  Rgb* radiance_;
  float* background_;
  TextureTable table_;
  size_t shadows_ = 0;                         // in arena_.shadow_by_light
  Coherence coherence_ = Coherence::coherent;  // of the wave at hand
};

}  // namespace

void trace_whitted(const Scene& scene, const AcceleratedScene& accelerated, const ShadingGroups& groups,
                   const RenderOptions& options, WaveArena& arena, Rgb* radiance, float* background) {
  if (arena.observer)
    Whitted<true>(scene, accelerated, groups, options, arena, radiance, background).run();
  else
    Whitted<false>(scene, accelerated, groups, options, arena, radiance, background).run();
}

}  // namespace alhazen
