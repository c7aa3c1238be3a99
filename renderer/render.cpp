#include "renderer/render.h"

#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>

#include "accel/shape_hits.h"
#include "core/fork_join.h"
#include "core/lane_memory.h"
#include "core/sampling.h"
#include "renderer/camera_cell.h"
#include "renderer/camera_ray.h"
#include "renderer/layer_recorder.h"
#include "renderer/moving.h"
#include "renderer/surface.h"
#include "renderer/trace_observer.h"
#include "renderer/whitted.h"

namespace alhazen {
namespace {

bool is_present(const void* data, const Crossing& crossing) noexcept {
  const Scene& scene = *static_cast<const Scene*>(data);
  const SurfacePoint s = surface_point(scene, crossing);
  const Material& material = scene.materials[s.material];
  return material.alpha_mode != AlphaMode::mask || coverage(material, texture_table(scene), s.inputs()) > 0;
}

/// Where it is the same at every point of a surface, which has vertex colours or not.
std::optional<Rgb> light_passing_anywhere(const Scene& scene, uint32_t material, bool has_colors) noexcept {
  if (has_colors || has_passing_textures(scene.materials[material])) return {};
  return straight_transmittance(scene.materials[material], texture_table(scene), {});
}

std::optional<Rgb> light_passing_shape(const void* data, uint32_t object) noexcept {
  const Scene& scene = *static_cast<const Scene*>(data);
  return light_passing_anywhere(scene, shape_instance(scene.geometry, object).material, false);
}

std::optional<Rgb> light_passing_part(const Scene& scene, const Crossing& crossing) noexcept {
  const TriangleMesh& part = part_of(scene.geometry, crossing.object, crossing.part);
  return light_passing_anywhere(scene, part.material, !part.colors.empty());
}

Rgb light_passing(const void* data, const Crossing& crossing) noexcept {
  const Scene& scene = *static_cast<const Scene*>(data);
  if (const auto passing = is_shape(scene.geometry, crossing.object) ? light_passing_shape(data, crossing.object)
                                                                     : light_passing_part(scene, crossing))
    return *passing;
  const SurfacePoint s = surface_point(scene, crossing);
  return straight_transmittance(scene.materials[s.material], texture_table(scene), s.inputs());
}

template <class U>
U seed_of(const U& x, const U& y) {
  return mix_bits<U>(x + mix_bits<U>(y));
}

/// Where a sample of a pixel lies on the film, in pixels from the top left: of one pixel, or of several lanes'.
template <class F>
Vec2<DoubleOf<F>> film_point(const IntOf<F>& x, const IntOf<F>& y, uint32_t sample, int samples) {
  using D = DoubleOf<F>;
  using U = UintOf<F>;
  const Vec2<D> middle{convert<D>(x) + D(0.5), convert<D>(y) + D(0.5)};
  if (samples == 1) return middle;
  const Vec2<U> bits = sobol_owen_bits(U(sample), seed_of(convert<U>(x), convert<U>(y)));
  const auto offset = [](const U& of) { return convert<D>(sample_tent<F>(unit_from_bits<F>(of))); };
  return {middle.x + offset(bits.x), middle.y + offset(bits.y)};
}

/// Into the elements from `first` on, of rows whose padding may be written to.
void store(const Vec3<ShadingLanes>& v, Vec3Lanes& rows, size_t first) {
  constexpr auto kAligned = std::experimental::element_aligned;
  v.x.copy_to(&rows.x[first], kAligned), v.y.copy_to(&rows.y[first], kAligned), v.z.copy_to(&rows.z[first], kAligned);
}

/// The camera rays of one sample of every pixel, in the order of `arena.pixels`.
void generate_camera_rays(const Camera& camera, const RenderOptions& options, const Cell& cell, uint32_t sample,
                          WaveArena& arena) {
  using F = ShadingLanes;
  using I = IntOf<F>;
  arena.pixels.list(cell);
  RayWave& rays = arena.pending.rays;
  rays.resize(arena.pixels.size());
  const Film film(camera, options.width, options.height);
  for (size_t first = 0; first < rays.size(); first += kWidthOf<F>) {
    const auto from = [&](const Lanes<int32_t>& row, int corner) {
      return I(&row[first], std::experimental::element_aligned) + I(corner);
    };
    const Vec2<DoubleOf<F>> p =
        film_point<F>(from(arena.pixels.x, cell.x0), from(arena.pixels.y, cell.y0), sample, options.samples);
    const FilmRay<F> through = film_ray<F>(film, p.x, p.y);
    store(through.origin, rays.origin, first), store(through.direction, rays.direction, first);
  }
  std::fill_n(rays.t_min.data(), rays.size(), Rayf{}.t_min);
  std::fill_n(rays.t_max.data(), rays.size(), Rayf{}.t_max);
}

/// The same on their way to their pixels.
void push_camera_rays(const Camera& camera, const RenderOptions& options, const Cell& cell, uint32_t sample,
                      WaveArena& arena) {
  generate_camera_rays(camera, options, cell, sample, arena);
  const CellPixels& pixels = arena.pixels;
  PathRows& paths = arena.pending.paths;
  paths.resize(0), paths.resize(pixels.size());
  for (size_t i = 0; i < pixels.size(); ++i) paths.pixel[i] = uint32_t(pixels.y[i] * kCellSize + pixels.x[i]);
  const Path start{.cone = camera_cone(camera, options.height, options.samples)};
  const auto fill = [&](auto& row, const auto& value) { std::fill_n(row.data(), pixels.size(), value); };
  fill(paths.red, start.weight.r), fill(paths.green, start.weight.g), fill(paths.blue, start.weight.b);
  fill(paths.depth, start.depth), fill(paths.kind, start.kind), fill(paths.roughness, start.roughness);
  fill(paths.cone_width, start.cone.width), fill(paths.cone_spread, start.cone.spread);
}

/// The same while the shutter is open: each at a time of its own, of a camera that may move.
void push_moving_camera_rays(const Camera& camera, const RenderOptions& options, const Cell& cell, uint32_t sample,
                             WaveArena& arena) {
  push_camera_rays(camera, options, cell, sample, arena);
  arena.time_of_pixel.resize(size_t(kCellSize) * kCellSize);
  for (size_t i = 0; i < arena.pixels.size(); ++i) {
    const int x = cell.x0 + arena.pixels.x[i], y = cell.y0 + arena.pixels.y[i];
    float& time = arena.time_of_pixel[arena.pending.paths.pixel[i]];
    time = third_sobol_owen(sample, seed_of(uint32_t(x), uint32_t(y)));
    if (camera.track.empty()) continue;
    const Vec2d p = film_point<float>(x, y, sample, options.samples);
    const Film film_then(at_time(camera.track, time), options.width, options.height);
    arena.pending.rays.set(i, camera_ray(film_then, p.x, p.y));
  }
}

/// One sample of each pixel of a cell, whose rows are kCellSize long.
struct CellSample {
  std::array<Rgb, kCellSize * kCellSize> radiance;
  std::array<float, kCellSize * kCellSize> background;  // how much of it is seen
};

struct CellSums {
  std::array<Vec3d, kCellSize * kCellSize> radiance{};
  std::array<double, kCellSize * kCellSize> background{};
  std::array<uint32_t, kCellSize * kCellSize> count{};

  /// But what is not finite; how many those are.
  uint32_t add(const CellSample& sample) {
    uint32_t dropped = 0;
    for (size_t p = 0; p < count.size(); ++p) {
      const Rgb& c = sample.radiance[p];
      if (!is_finite(c)) {
        ++dropped;
        continue;
      }
      radiance[p] += Vec3d(c.r, c.g, c.b), background[p] += double(sample.background[p]);
      ++count[p];
    }
    return dropped;
  }
};

struct CellWorker {
  const Scene& scene;
  const AcceleratedScene& accelerated;
  const ShadingGroups& groups;
  const Camera& camera;
  const RenderOptions& options;
  RenderControl& control;
  RenderResult& result;
  bool moving;         // while the shutter is open
  int x0 = 0, y0 = 0;  // of the result in the picture

  /// Fills the cell's pixels; false where it was stopped before they were finished: they are to be cleared.
  [[nodiscard]] bool trace(const Cell& cell, WaveArena& arena) const {
    if (control.stop) return false;
    const uint64_t doubts_before = doubt_counts().quad;
    CellWaves log;
    arena.log = control.log ? &log : nullptr;
    arena.clock.splits_shading = control.splits_shading;
    bool finished = true;
    if (options.integrator == Integrator::whitted)
      finished = options.layers.empty() ? whitted(cell, arena) : whitted_with_layers(cell, arena);
    else
      signature(cell, arena);
    control.doubts += doubt_counts().quad - doubts_before;
    const PhaseNanoseconds spent = arena.clock.take();
    for (size_t k = 0; k < kPhases; ++k) control.phase_ns[k] += spent[k];
    if (control.log && finished) control.log->add(std::move(log));
    return finished;
  }

  /// Nothing is seen.
  void clear(const Cell& cell) const {
    const auto fill = [&](auto& picture, auto value) {
      if (picture.pixels.empty()) return;
      const size_t count = size_t(cell.x1 - cell.x0) * picture.channels.size();
      for (int y = cell.y0; y < cell.y1; ++y) std::fill_n(picture.at(cell.x0 - x0, y - y0), count, value);
    };
    fill(result.color, 0.0f), fill(result.ids, kNone);
  }

  void signature(const Cell& cell, WaveArena& arena) const {
    arena.clock.enter(Phase::generation);
    generate_camera_rays(camera, options, cell, 0, arena);
    const RayWave& rays = arena.pending.rays;
    if (arena.log) arena.log->push_back(logged(WaveKind::camera, rays));
    arena.clock.enter(Phase::traversal);
    accelerated.intersect(rays, Coherence::coherent, arena.hits);
    arena.clock.enter(Phase::film);
    write_ids(cell, arena);
    control.camera_rays += rays.size();
  }

  /// What the cell's rays have hit, at their pixels: put together close by, for the picture's memory is far and likes
  /// to be written in order.
  void write_ids(const Cell& cell, const WaveArena& arena) const {
    using U = UintOf<ShadingLanes>;
    using I = IntOf<ShadingLanes>;
    constexpr auto anywhere = std::experimental::element_aligned;
    std::array<uint32_t, size_t(kCellSize) * kCellSize * 3> ids;
    SurfaceIdReader ids_of(scene);
    for (size_t first = 0; first < arena.pixels.size(); first += kWidthOf<U>) {
      const I x(&arena.pixels.x[first], anywhere), y(&arena.pixels.y[first], anywhere);
      const U object(&arena.hits.object[first], anywhere), part(&arena.hits.part[first], anywhere),
          primitive(&arena.hits.primitive[first], anywhere);
      const size_t count = std::min(kWidthOf<U>, arena.pixels.size() - first);
      store_triples_at(address_of<I>(ids.data(), (y * I(kCellSize) + x) * I(3)), ids_of(object, part, primitive, count),
                       count);
    }
    for (int y = cell.y0; y < cell.y1; ++y)
      std::copy_n(&ids[size_t(y - cell.y0) * kCellSize * 3], (cell.x1 - cell.x0) * 3,
                  result.ids.at(cell.x0 - x0, y - y0));
  }

  [[nodiscard]] bool whitted_with_layers(const Cell& cell, WaveArena& arena) const {
    LayerRecorder recorder(scene, camera, options.layers, result.layers, options.width);
    arena.observer = &recorder;
    const bool finished = whitted(cell, arena);
    arena.observer = nullptr;
    if (finished) recorder.finish(cell, options.samples);
    return finished;
  }

  [[nodiscard]] bool whitted(const Cell& cell, WaveArena& arena) const {
    CellSample sample;
    uint32_t dropped = 0;
    if (options.samples == 1) {
      if (!trace_sample(0, cell, arena, sample)) return false;
      write(cell, [&](size_t p) {
        const bool counts = is_finite(sample.radiance[p]);
        dropped += !counts;
        return counts ? Rgba{sample.radiance[p], opacity_before(double(sample.background[p]))} : Rgba{Rgb(0.0f), 0};
      });
    } else {
      CellSums sums;
      for (int k = 0; k < options.samples; ++k) {
        if (!trace_sample(k, cell, arena, sample)) return false;
        dropped += sums.add(sample);
      }
      write(cell, [&](size_t p) {
        const double scale = sums.count[p] ? 1.0 / sums.count[p] : 0;
        const Vec3d mean = sums.radiance[p] * scale;
        return Rgba{{float(mean.x), float(mean.y), float(mean.z)},
                    sums.count[p] ? opacity_before(sums.background[p] * scale) : 0.0f};
      });
    }
    if (dropped > 0) control.dropped_samples += dropped;
    control.camera_rays += arena.rays_by_kind[0] + arena.rays_by_kind[3];
    control.mirror_rays += arena.rays_by_kind[1], control.refracted_rays += arena.rays_by_kind[2];
    control.shadow_rays += arena.shadow_rays;
    arena.rays_by_kind = {}, arena.shadow_rays = 0;
    return true;
  }

  [[nodiscard]] bool trace_sample(int k, const Cell& cell, WaveArena& arena, CellSample& sample) const {
    if (control.stop) return false;
    arena.clock.enter(Phase::generation);
    sample.radiance.fill(Rgb(0.0f)), sample.background.fill(0.0f);
    (moving ? push_moving_camera_rays : push_camera_rays)(camera, options, cell, uint32_t(k), arena);
    if (arena.observer) arena.observer->begin_sample(k, arena.pending, arena.time_of_pixel);
    trace_whitted(scene, accelerated, groups, options, arena, sample.radiance.data(), sample.background.data());
    arena.clock.enter(Phase::film);
    return true;
  }

  /// How much of a pixel is covered before so much of the background.
  static float opacity_before(double background) { return std::max(0.0f, float(1 - background)); }

  template <class PixelOf>
  void write(const Cell& cell, const PixelOf& pixel) const {
    for (uint32_t y = 0; y < uint32_t(cell.y1 - cell.y0); ++y) {
      float* out = result.color.at(cell.x0 - x0, cell.y0 - y0 + int(y));
      for (uint32_t x = 0; x < uint32_t(cell.x1 - cell.x0); ++x, out += 4) {
        const Rgba c = pixel(y * kCellSize + x);
        out[0] = c.rgb.r, out[1] = c.rgb.g, out[2] = c.rgb.b, out[3] = c.a;
      }
    }
  }
};

Cell cell_at(int cx, int cy, const RenderOptions& options) {
  return {cx * kCellSize, cy * kCellSize, std::min((cx + 1) * kCellSize, options.width),
          std::min((cy + 1) * kCellSize, options.height)};
}

/// In the memory of another; what was seen there may still be.
template <class T>
PixelBuffer<T> blank(int width, int height, std::vector<std::string> channels, std::vector<T> memory) {
  memory.resize(size_t(width) * size_t(height) * channels.size());
  return {width, height, std::move(channels), std::move(memory)};
}

ColorImage blank_picture(int width, int height, std::vector<float> memory) {
  return blank(width, height, {"R", "G", "B", "A"}, std::move(memory));
}

}  // namespace

SurfaceFilter surface_filter(const Scene& scene, std::vector<Opacity>& opacities) {
  opacities.clear();
  for (const Material& material : scene.materials) opacities.push_back(opacity(material));
  return {opacities, &scene, is_present, light_passing, light_passing_shape};
}

RenderResult render(const Scene& scene, const AcceleratedScene& accelerated, const Camera& camera,
                    const RenderOptions& options, RenderControl& control, RenderResult used) {
  RenderResult result;
  const size_t pixels = size_t(options.width) * size_t(options.height);
  if (options.integrator == Integrator::signature) {
    result.ids = blank(options.width, options.height, {"node", "primitive", "material"}, std::move(used.ids.pixels));
  } else {
    result.color = blank_picture(options.width, options.height, std::move(used.color.pixels));
    result.layers = empty_layers(scene, options.layers, options.width, options.height);
  }
  const ShadingGroups groups(scene);
  const CellWorker worker{scene, accelerated, groups, camera, options, control, result, is_moving(scene, camera)};
  const int cells_x = (options.width + kCellSize - 1) / kCellSize,
            cells_y = (options.height + kCellSize - 1) / kCellSize;
  const int side = std::max(1, (options.tile_size + kCellSize - 1) / kCellSize);  // cells a side of a tile
  const int tiles_x = (cells_x + side - 1) / side, tiles_y = (cells_y + side - 1) / side;
  control.tiles = uint32_t(tiles_x * tiles_y);

  tbb::enumerable_thread_specific<WaveArena> arenas;
  tbb::task_arena threads(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  threads.execute([&] {
    const ForkJoin order;
    tbb::parallel_for(0, tiles_x * tiles_y, order.task([&](int tile) {
      const int cx0 = tile % tiles_x * side, cy0 = tile / tiles_x * side;
      bool whole = true;
      for (int cy = cy0; cy < std::min(cy0 + side, cells_y); ++cy)
        for (int cx = cx0; cx < std::min(cx0 + side, cells_x); ++cx) {
          const Cell cell = cell_at(cx, cy, options);
          if (worker.trace(cell, arenas.local()))
            control.pixels_done += uint64_t(cell.x1 - cell.x0) * uint64_t(cell.y1 - cell.y0);
          else
            whole = false, worker.clear(cell);
        }
      if (!whole) return;
      if (control.tiles_done++ == 0)
        control.first_tile_ns = std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
    }));
  });
  result.complete = control.pixels_done == pixels;
  return result;
}

CellPicture render_cell(const Scene& scene, const AcceleratedScene& accelerated, const Camera& camera,
                        const RenderOptions& options, RenderControl& control, int x, int y, TraceObserver& observer) {
  const Cell cell = cell_at(x / kCellSize, y / kCellSize, options);
  RenderResult result;
  result.color = blank_picture(cell.x1 - cell.x0, cell.y1 - cell.y0, {});
  WaveArena arena;
  arena.observer = &observer;
  RenderOptions alone = options;  // the observer is told, not the layers
  alone.layers.clear();
  const ShadingGroups groups(scene);
  const CellWorker worker{scene,   accelerated, groups, camera, alone, control, result, is_moving(scene, camera),
                          cell.x0, cell.y0};
  if (!worker.trace(cell, arena)) return {};
  return {cell.x0, cell.y0, std::move(result.color)};
}

}  // namespace alhazen
