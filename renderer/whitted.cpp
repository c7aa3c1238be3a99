#include "renderer/whitted.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/lane_memory.h"
#include "renderer/block_shading.h"
#include "renderer/hit_shading.h"
#include "renderer/shading_terms.h"

namespace alhazen {
namespace {

constexpr size_t kWaveLimit = 4096;    // rays traced together; what is left waits, so that memory stays bounded
constexpr size_t kShadowLimit = 8192;  // shadow rays gathered before they are traced

/// `observed`: as PixelSink.
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
        sink_{arena, radiance},
        background_(background) {
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
      arena_.spawned.move_to(arena_.pending);
      trace_shadows();
      first = false;
    }
  }

 private:
  template <class PixelOf>
  void set_times(RayWave& rays, const PixelOf& pixel_of) const {
    if (arena_.time_of_pixel.size() == 0) return;
    rays.time.resize(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) rays.time[i] = arena_.time_of(pixel_of(i));
  }

  void count_rays(bool of_camera) {
    const size_t n = arena_.current.size();
    if (of_camera) return (void)(arena_.rays_by_kind[size_t(RayKind::camera)] += n);
    const RayKind* const kinds = arena_.current.paths.kind.data();
    for (const RayKind kind : {RayKind::camera, RayKind::mirror, RayKind::refracted, RayKind::straight})
      arena_.rays_by_kind[size_t(kind)] += size_t(std::count(kinds, kinds + n, kind));
  }

  void log(WaveKind kind, const RayWave& rays) {
    if (arena_.log && rays.size() > 0) arena_.log->push_back(logged(kind, rays));
  }

  template <class Event>
  void tell(const Event& event) const {
    sink_.tell(event);
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
    sort_by_group(arena_.hits, scene_.geometry, groups_, arena_.hits_by_group);
    const bool lanes = !observed && arena_.time_of_pixel.size() == 0;
    uint32_t* const rays = arena_.hits_by_group.sorted.data();
    size_t first = 0;
    for (size_t group = 0; group < groups_.size(); ++group) {
      const size_t end = arena_.hits_by_group.ends[group];
      for (; first < end; first += std::min(kLanes, end - first)) {
        const std::span<const uint32_t> block(rays + first, std::min(kLanes, end - first));
        if (lanes && groups_[group].in_lanes)
          shade_block(scene_, options_, groups_[group], block, arena_, sink_.radiance);
        else
          shade_one_by_one(block);
        if (arena_.shadows_waiting >= kShadowLimit) trace_shadows();
      }
    }
    shade_misses({rays + first, arena_.current.size() - first});
  }

  void shade_one_by_one(std::span<const uint32_t> hits) {
    for (const uint32_t i : hits) {
      tell([&](TraceObserver& observer) { observer.look_at(i); });
      shade_hit(scene_, options_, sink_, i);
    }
  }

  static constexpr size_t kLanes = kWidthOf<ShadingLanes>;

  /// First those that see the background; the others' numbers move to the front of `rays`.
  void shade_misses(std::span<uint32_t> rays) {
    if (!observed && !scene_.environment && !options_.transparent) return add_background(rays);
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
        sink_.add(path.pixel, LightTerm::background, path.weight * scene_.background);
        continue;
      }
      background_[path.pixel] += path.weight.r;  // a product of (1 - alpha): grey
      tell([&](TraceObserver& observer) { observer.uncover(path.weight.r); });
    }
    add_environment(rays.first(others));
  }

  void add_environment(std::span<const uint32_t> rays) {
    const Environment& environment = *scene_.environment;
    const PathRows& paths = arena_.current.paths;
    const Vec3Lanes& direction = arena_.current.rays.direction;
    if constexpr (observed) {
      for (const uint32_t i : rays) {
        tell([&](TraceObserver& observer) { observer.look_at(i); });
        sink_.add(paths.pixel[i], LightTerm::environment,
                  paths.weight(i) * environment_radiance(environment, direction.get(i), paths.roughness[i]));
      }
    } else {
      add_in_lanes(rays, [&](const auto& load) {
        const Vec3<ShadingLanes> d{load(direction.x), load(direction.y), load(direction.z)};
        return environment_radiance(environment, d, load(paths.roughness));
      });
    }
  }

  /// Where it is all that rays can see.
  void add_background(std::span<const uint32_t> rays) {
    if (scene_.background == Rgb(0.0f)) return;
    add_in_lanes(rays, [&](const auto&) { return BasicRgb<ShadingLanes>(scene_.background); });
  }

  /// To each ray's pixel its weight times `radiance(load)`; `load(row)`: what the rays of a block have there.
  template <class Radiance>
  void add_in_lanes(std::span<const uint32_t> rays, const Radiance& radiance) {
    const PathRows& paths = arena_.current.paths;
    for (size_t first = 0; first < rays.size(); first += kLanes) {
      const std::span<const uint32_t> block = rays.subspan(first, std::min(kLanes, rays.size() - first));
      LaneArray<IntOf<ShadingLanes>> numbers;
      for (size_t k = 0; k < kLanes; ++k) numbers[k] = int32_t(block[k < block.size() ? k : 0]);
      const LanePicker<ShadingLanes> picker(numbers.load(), block.front(), block.back());
      const auto load = [&](const Lanes<float>& row) { return picker.pick<ShadingLanes>(row); };
      const BasicRgb<ShadingLanes> weight{load(paths.red), load(paths.green), load(paths.blue)};
      RgbArray<ShadingLanes> light;
      light.store(weight * radiance(load));
      for (size_t k = 0; k < block.size(); ++k) sink_.radiance[paths.pixel[block[k]]] += light.get(k);
    }
  }

  /// Of a ray that leaves the scene; else it sees the environment.
  [[nodiscard]] bool sees_background(RayKind kind) const {
    if (!scene_.environment) return true;
    return scene_.environment->seen ? is_view(kind) && scene_.has_background : kind != RayKind::mirror;
  }
  /// Light by light, so that neighbours run side by side.
  void trace_shadows() {
    if (arena_.shadows_waiting == 0) return;
    ShadowWave& all = gather_shadows();
    arena_.shadow_rays += std::exchange(arena_.shadows_waiting, 0);
    set_times(all.rays, [&](size_t i) { return all.pixel[i]; });
    log(coherence_ == Coherence::coherent ? WaveKind::camera_shadow : WaveKind::bounced_shadow, all.rays);
    arena_.clock.enter(Phase::traversal);
    accelerated_.transmittance(all.rays, coherence_, arena_.visible);
    arena_.clock.enter(Phase::shading);
    for (size_t i = 0; i < all.size(); ++i) {
      const Rgb light = Rgb{all.red[i], all.green[i], all.blue[i]} * arena_.visible[i];
      sink_.radiance[all.pixel[i]] += light;
      tell([&](TraceObserver& observer) { observer.answer(all.number[i], arena_.visible[i], light); });
    }
    tell([&](TraceObserver& observer) { observer.answered(); });
    all.clear();
  }

  /// Those of all lights, behind those of the first.
  ShadowWave& gather_shadows() {
    ShadowWave& all = arena_.shadow_by_light.front();
    for (ShadowWave& wave : std::span(arena_.shadow_by_light).subspan(1)) all.append(wave), wave.clear();
    return all;
  }

  const Scene& scene_;
  const AcceleratedScene& accelerated_;
  const ShadingGroups& groups_;
  const RenderOptions& options_;
  WaveArena& arena_;
  PixelSink<observed> sink_;
  float* background_;
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
